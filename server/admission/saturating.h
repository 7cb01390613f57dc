#ifndef BCCSKEL_SERVER_ADMISSION_SATURATING_H_
#define BCCSKEL_SERVER_ADMISSION_SATURATING_H_

#include <cstdint>
#include <limits>

namespace bccskel::server {

// Needs of hostile declarations stay at the largest number instead of wrapping around.
inline uint64_t SaturatingAdd(uint64_t a, uint64_t b) {
  uint64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? std::numeric_limits<uint64_t>::max() : sum;
}

inline uint64_t SaturatingMultiply(uint64_t a, uint64_t b) {
  uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? std::numeric_limits<uint64_t>::max() : product;
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_SATURATING_H_
