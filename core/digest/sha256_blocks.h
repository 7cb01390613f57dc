#ifndef BCCSKEL_CORE_DIGEST_SHA256_BLOCKS_H_
#define BCCSKEL_CORE_DIGEST_SHA256_BLOCKS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace bccskel {

using Sha256State = std::array<uint32_t, 8>;
inline constexpr size_t kSha256Block = 64;  // bytes

// What FIPS 180-4 does with whole blocks of a message, by the processor's instructions where it has
// them. Shapes: a multiple of kSha256Block bytes.
void AddSha256Blocks(std::span<const std::byte> blocks, Sha256State& state);
void AddPlainSha256Blocks(std::span<const std::byte> blocks, Sha256State& state);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DIGEST_SHA256_BLOCKS_H_
