// Does:  tells Highway which instruction sets this processor has, in place of Highway's own
//        library, which measures the resolution of the timer whenever it is loaded: 3.6 ms at every
//        start.

#include <cpuid.h>

#include <cstdint>
#include <initializer_list>

#include "hwy/highway.h"
#include "hwy/targets.h"

namespace {

constexpr uint32_t Bits(std::initializer_list<int> places) {
  uint32_t bits = 0;
  for (int place : places) bits |= 1U << place;
  return bits;
}

// Features as reported by CPUID: registers of leaves 1, 7 and 0x80000001.
struct Features {
  uint32_t basic_c = 0, more_b = 0, more_c = 0, extended_c = 0;

  bool Have(const Features& wanted) const {
    return (~basic_c & wanted.basic_c) == 0 && (~more_b & wanted.more_b) == 0 &&
           (~more_c & wanted.more_c) == 0 && (~extended_c & wanted.extended_c) == 0;
  }
};

// SSE3, SSSE3.
constexpr uint32_t kSsse3 = Bits({0, 9});
// With SSE4.1, SSE4.2, PCLMUL, AES.
constexpr uint32_t kSse4 = kSsse3 | Bits({19, 20, 1, 25});
// With OSXSAVE, AVX, FMA, F16C.
constexpr uint32_t kAvx = kSse4 | Bits({27, 28, 12, 29});
// BMI, AVX2, BMI2.
constexpr uint32_t kAvx2 = Bits({3, 5, 8});
// With AVX-512 F, DQ, CD, BW, VL.
constexpr uint32_t kAvx512 = kAvx2 | Bits({16, 17, 28, 30, 31});
// AVX-512 VBMI, VBMI2, GFNI, VAES, VPCLMULQDQ, VNNI, BITALG, VPOPCNTDQ.
constexpr uint32_t kAvx512More = Bits({1, 6, 8, 9, 10, 11, 12, 14});
constexpr uint32_t kLzcnt = Bits({5});

// Register state that the operating system saves: XMM and YMM, then also those of AVX-512.
constexpr uint32_t kYmmState = Bits({1, 2});
constexpr uint32_t kZmmState = kYmmState | Bits({5, 6, 7});

Features FeaturesOfProcessor() {
  Features found;
  uint32_t a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) != 0) found.basic_c = c;
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) != 0) {
    found.more_b = b;
    found.more_c = c;
  }
  if (__get_cpuid(0x80000001, &a, &b, &c, &d) != 0) found.extended_c = c;
  return found;
}

// Needs: the processor has OSXSAVE.
uint32_t SavedState() {
  uint32_t low = 0, high = 0;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

int64_t DetectTargets() {
  const Features found = FeaturesOfProcessor();
  int64_t targets = HWY_ENABLED_BASELINE | HWY_EMU128 | HWY_SCALAR;
  if (found.Have({.basic_c = kSsse3})) targets |= HWY_SSSE3;
  if (found.Have({.basic_c = kSse4})) targets |= HWY_SSE4;
  if (!found.Have({.basic_c = kAvx, .more_b = kAvx2, .extended_c = kLzcnt})) return targets;
  const uint32_t saved = SavedState();
  if ((~saved & kYmmState) != 0) return targets;
  targets |= HWY_AVX2;
  if ((~saved & kZmmState) != 0 || !found.Have({.more_b = kAvx512})) return targets;
  targets |= HWY_AVX3;
  if (found.Have({.more_c = kAvx512More})) targets |= HWY_AVX3_DL;
  return targets;
}

int64_t wanted_targets = 0;  // 0: all

}  // namespace

namespace hwy {

int64_t SupportedTargets() {
  static const int64_t detected = DetectTargets();
  return wanted_targets == 0 ? detected : wanted_targets;
}

void SetSupportedTargetsForTest(int64_t targets) { wanted_targets = targets; }

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

}  // namespace hwy
