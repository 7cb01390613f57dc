#ifndef BCCSKEL_TESTS_SUPPORT_SANITIZED_H_
#define BCCSKEL_TESTS_SUPPORT_SANITIZED_H_

#include <cstdint>

namespace bccskel::test {

// Sanitizers look at how code runs, which few objects of a kind show, and take ten times as long:
// laws take every `kStride`-th object there. The release build judges results and takes all.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
inline constexpr int kStride = kSanitized ? 7 : 1;  // prime: all options that take turns come up

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_SANITIZED_H_
