#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "core/exec/context.h"
#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/contexts.h"

// The allocator of this program fails on demand, for all but the words of messages: Abseil ends the
// process where it cannot have those.

namespace {

constexpr size_t kWordsOfAMessage = 200;
constexpr long kNever = std::numeric_limits<long>::max();
enum class Victim { kMainThread, kOtherThreads };
std::atomic<long> allocations_left{kNever};
std::atomic<Victim> victim{Victim::kOtherThreads};
thread_local bool is_main_thread = false;

void* AllocateOrNull(size_t bytes) noexcept {
  const bool counted =
      bytes > kWordsOfAMessage && is_main_thread == (victim == Victim::kMainThread);
  if (counted && allocations_left != kNever && --allocations_left == 0) return nullptr;
  return std::malloc(bytes);
}

void* AllocateOrThrow(size_t bytes) {
  void* const memory = AllocateOrNull(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(size_t bytes) { return AllocateOrThrow(bytes); }
void* operator new[](size_t bytes) { return AllocateOrThrow(bytes); }
// The buffers of stable sorts, which do without.
void* operator new(size_t bytes, const std::nothrow_t&) noexcept { return AllocateOrNull(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }

namespace bccskel {
namespace {

enum class End { kNotReached, kDidWithout, kOutOfMemory };

End SkeletonizeWith(const Volume& object, const SkeletonizeOptions& options, long allocations) {
  test::TeamContext context(3);
  allocations_left = allocations;
  End end = End::kDidWithout;
  try {
    EXPECT_TRUE(Skeletonize(object, options, context).ok());
  } catch (const std::bad_alloc&) {
    end = End::kOutOfMemory;
  }
  if (allocations_left > 0) end = End::kNotReached;
  allocations_left = kNever;
  return end;
}

// One allocation after the other, up to the first that is not reached any more.
int FailuresOf(Victim which, const SkeletonizeOptions& options) {
  is_main_thread = true;
  victim = which;
  const Volume torus = *GenerateShape(Shape::kTorus, {.points = 5'000});
  int failures = 0;
  End end = End::kDidWithout;
  for (long n = 1; end != End::kNotReached; ++n) {
    end = SkeletonizeWith(torus, options, n);
    if (end == End::kOutOfMemory) ++failures;
  }
  return failures;
}

TEST(OutOfMemory, InAWorkerEndsTheComputationAndNotTheProcess) {
  EXPECT_GT(FailuresOf(Victim::kOtherThreads, {}), 4);
}

TEST(OutOfMemory, InTheCallersThreadEndsTheComputationAndNotTheProcess) {
  EXPECT_GT(FailuresOf(Victim::kMainThread, {}), 20);
}

}  // namespace
}  // namespace bccskel
