#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_CAPTION_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_CAPTION_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "client/view/result_document.h"
#include "core/certificate/certificate.h"

namespace bccskel::exporting {

// "12,345,678".
std::string GroupedDigits(uint64_t number);

// "1 node", "1,485 nodes".
std::string Counted(uint64_t count, std::string_view one, std::string_view many);

// "1 component, 3 loops, 0 cavities".
std::string BettiPhrase(const BettiNumbers& betti);

// The words under a picture's title: the input, and the result, whose certificate
// VerdictInWords() describes. `size`: of the skeleton, such as "12 points".
std::string ObjectPhrase(const view::ResultDocument& result);
std::string SkeletonPhrase(const view::ResultFacts& result, const std::string& size);

// " mm", to follow a length; "" if the unit is unknown.
std::string UnitBehind(const view::ResultFacts& result);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_CAPTION_H_
