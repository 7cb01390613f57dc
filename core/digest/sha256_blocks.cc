#include "core/digest/sha256_blocks.h"

#include <bit>

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace bccskel {
namespace {

constexpr std::array<uint32_t, 64> kRounds = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

uint32_t BigEndianAt(std::span<const std::byte> bytes, size_t first) {
  uint32_t word = 0;
  for (size_t n = 0; n < sizeof(word); ++n) {
    word = word << 8 | static_cast<uint32_t>(bytes[first + n]);
  }
  return word;
}

std::array<uint32_t, 64> ScheduleOf(std::span<const std::byte> block) {
  std::array<uint32_t, 64> w;
  for (size_t t = 0; t < 16; ++t) w[t] = BigEndianAt(block, 4 * t);
  for (size_t t = 16; t < w.size(); ++t) {
    const uint32_t a = w[t - 15], b = w[t - 2];
    w[t] = w[t - 16] + w[t - 7] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) +
           (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
  }
  return w;
}

#if defined(__x86_64__)
bool HasShaInstructions() {
  uint32_t eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __builtin_cpu_supports("sse4.1") && __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0 &&
         (ebx & uint32_t{1} << 29) != 0;
}

// The instructions want the state's words in the order ABEF, CDGH.
__attribute__((target("sha,sse4.1"))) void AddFastBlocks(std::span<const std::byte> blocks,
                                                         Sha256State& state) {
  const __m128i big_endian = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
  auto* words = reinterpret_cast<__m128i*>(state.data());
  const __m128i cdab = _mm_shuffle_epi32(_mm_loadu_si128(words), 0xB1);
  const __m128i efgh = _mm_shuffle_epi32(_mm_loadu_si128(words + 1), 0x1B);
  __m128i abef = _mm_alignr_epi8(cdab, efgh, 8), cdgh = _mm_blend_epi16(efgh, cdab, 0xF0);
  for (; !blocks.empty(); blocks = blocks.subspan(kSha256Block)) {
    const auto* bytes = reinterpret_cast<const __m128i*>(blocks.data());
    const __m128i abef_before = abef, cdgh_before = cdgh;
    __m128i w[4];  // the last 16 words of the schedule
    for (size_t n = 0; n < 16; ++n) {
      __m128i& next = w[n % 4];
      if (n < 4) {
        next = _mm_shuffle_epi8(_mm_loadu_si128(bytes + n), big_endian);
      } else {
        const __m128i last = w[(n + 3) % 4], seventh = _mm_alignr_epi8(last, w[(n + 2) % 4], 4);
        next = _mm_sha256msg1_epu32(next, w[(n + 1) % 4]);
        next = _mm_sha256msg2_epu32(_mm_add_epi32(next, seventh), last);
      }
      const auto* rounds = reinterpret_cast<const __m128i*>(kRounds.data() + 4 * n);
      const __m128i sum = _mm_add_epi32(next, _mm_loadu_si128(rounds));
      cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
      abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0E));
    }
    abef = _mm_add_epi32(abef, abef_before);
    cdgh = _mm_add_epi32(cdgh, cdgh_before);
  }
  const __m128i feba = _mm_shuffle_epi32(abef, 0x1B), dchg = _mm_shuffle_epi32(cdgh, 0xB1);
  _mm_storeu_si128(words, _mm_blend_epi16(feba, dchg, 0xF0));
  _mm_storeu_si128(words + 1, _mm_alignr_epi8(dchg, feba, 8));
}
#endif

}  // namespace

void AddPlainSha256Blocks(std::span<const std::byte> blocks, Sha256State& state) {
  for (; !blocks.empty(); blocks = blocks.subspan(kSha256Block)) {
    const std::array<uint32_t, 64> w = ScheduleOf(blocks.first(kSha256Block));
    auto [a, b, c, d, e, f, g, h] = state;
    for (size_t t = 0; t < w.size(); ++t) {
      const uint32_t one = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                           ((e & f) ^ (~e & g)) + kRounds[t] + w[t];
      const uint32_t two =
          (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + one;
      d = c, c = b, b = a, a = one + two;
    }
    const Sha256State add = {a, b, c, d, e, f, g, h};
    for (size_t n = 0; n < add.size(); ++n) state[n] += add[n];
  }
}

void AddSha256Blocks(std::span<const std::byte> blocks, Sha256State& state) {
#if defined(__x86_64__)
  static const bool kIsFast = HasShaInstructions();
  if (kIsFast) return AddFastBlocks(blocks, state);
#endif
  AddPlainSha256Blocks(blocks, state);
}

}  // namespace bccskel
