#ifndef BCCSKEL_CLIENT_VIEW_PACKED_NUMBERS_H_
#define BCCSKEL_CLIENT_VIEW_PACKED_NUMBERS_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/statusor.h"

namespace bccskel::view {

// Numbers as text that a page can hold and a browser unpacks by itself: the difference of each to
// the one before, zigzag, in bytes of seven bits; deflated (zlib) and in base64.
// Errors: RESOURCE_EXHAUSTED when the compressor finds no memory.
absl::StatusOr<std::string> PackNumbers(std::span<const uint32_t> numbers);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_PACKED_NUMBERS_H_
