#ifndef BCCSKEL_CLIENT_EXPORT_METHOD_FACTS_H_
#define BCCSKEL_CLIENT_EXPORT_METHOD_FACTS_H_

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/text.h"
#include "client/export/world.h"
#include "client/view/result_document.h"
#include "core/certificate/certificate.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// How a result was made: names and values for formats without structure. First `method` in words,
// then `algorithm_version`, then `world` and `unit`, "unknown" if the input does not state them,
// then the options; `prepared` lists what preparation did, and `check` says what the certificate
// proves. Plain text without quotes.
using MethodFacts = std::vector<std::pair<std::string, std::string>>;
MethodFacts MethodFactsOf(const SkeletonizeResult& result, const World& world = {});
// For a result read from a file.
MethodFacts MethodFactsOf(const view::ResultFacts& result);

// Empty if there is none of this name.
std::string_view FactNamed(const MethodFacts& facts, std::string_view name);

// One line for each fact, such as "# unit: mm".
void AddComments(Text& text, const MethodFacts& facts);

// As JSON values: an object of the options, and a list of the steps of preparation.
std::string OptionsJson(const SkeletonizeOptions& options);
std::string PreparingJson(const std::vector<PreparingStep>& steps);

// Members of an object: "spacing":[...],"origin":[...],"direction":[...]
std::string PlacementJson(const Placement& placement);

// An object of three numbers, and an object with those of mask, object and skeleton.
std::string BettiJson(const BettiNumbers& betti);
std::string CertificateJson(const Certificate& certificate);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_METHOD_FACTS_H_
