#ifndef BCCSKEL_CLIENT_VIEW_PACKED_NUMBERS_H_
#define BCCSKEL_CLIENT_VIEW_PACKED_NUMBERS_H_

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/exec/context.h"

namespace bccskel::view {

// The bytes deflated, in the format of zlib.
// Errors: RESOURCE_EXHAUSTED when the compressor gets no memory; those of the context.
absl::StatusOr<std::string> Deflate(std::string_view bytes, const exec::Context& context = {});

// Text that a page can hold and a browser can unpack: deflated, in base64. Errors: as Deflate().
absl::StatusOr<std::string> PackText(std::string_view text, const exec::Context& context = {});

// Packed as above: the difference of each number to the previous one, zigzag-encoded, in bytes of
// seven bits.
absl::StatusOr<std::string> PackNumbers(std::span<const uint32_t> numbers,
                                        const exec::Context& context = {});

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_PACKED_NUMBERS_H_
