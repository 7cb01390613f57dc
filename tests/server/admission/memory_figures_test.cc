// What is reserved for a job covers what it allocates, whatever the object looks like. The global
// operators below count.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include "core/pipeline/skeletonize_within.h"
#include "server/admission/memory_estimate.h"
#include "tests/support/cell_patterns.h"

namespace {

std::atomic<int64_t> allocated = 0, peak = 0;

void* Count(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  const int64_t now = allocated += static_cast<int64_t>(malloc_usable_size(block) + sizeof(size_t));
  int64_t seen = peak;
  while (now > seen && !peak.compare_exchange_weak(seen, now)) {
  }
  return block;
}

void Discount(void* block) {
  if (block == nullptr) return;
  allocated -= static_cast<int64_t>(malloc_usable_size(block) + sizeof(size_t));
  std::free(block);
}

void* Aligned(size_t size, std::align_val_t alignment) {
  const auto step = static_cast<size_t>(alignment);
  return Count(std::aligned_alloc(step, (size + step - 1) / step * step));
}

}  // namespace

void* operator new(size_t size) { return Count(std::malloc(size)); }
void* operator new(size_t size, std::align_val_t alignment) { return Aligned(size, alignment); }
void* operator new(size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return Aligned(size, alignment);
}
void operator delete(void* block) noexcept { Discount(block); }
void operator delete(void* block, size_t) noexcept { Discount(block); }
void operator delete(void* block, std::align_val_t) noexcept { Discount(block); }
void operator delete(void* block, size_t, std::align_val_t) noexcept { Discount(block); }

namespace bccskel::server {
namespace {

using test::IsDust, test::IsIn, test::Net;

// Grants everything and remembers how much.
class CountedMemory final : public exec::MemoryBudget {
 public:
  absl::Status Take(uint64_t bytes, const std::string&) override {
    taken_ += bytes;
    return absl::OkStatus();
  }
  void GiveBack(uint64_t bytes) override { taken_ -= bytes; }
  uint64_t taken() const { return taken_; }

 private:
  uint64_t taken_ = 0;
};

// So many percent of the points, at random.
IsIn Noise(uint64_t percent) {
  return [percent](int32_t i, int32_t j, int32_t k, int sublattice) {
    std::mt19937_64 random(static_cast<uint64_t>(((k * 512 + j) * 512 + i) * 2 + sublattice));
    return random() % 100 < percent;
  };
}

void ExpectCovered(const IsIn& is_in, const SkeletonizeOptions& options = {}) {
  const Volume volume = test::VolumeOfCells({32, 32, 32}, is_in);
  CountedMemory memory;
  const int64_t before = allocated;
  peak = before;
  const auto result = SkeletonizeWithin(memory, volume, options, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const auto needed = static_cast<uint64_t>(peak - before);
  EXPECT_LE(needed, BytesToSkeletonize(volume) + memory.taken())
      << volume.brick_count() << " bricks, " << memory.taken() << " bytes taken, "
      << result->graph.points.size() << " points on edges";
}

SkeletonizeOptions Options(SkeletonKind kind) {
  SkeletonizeOptions options;
  options.thinning.kind = kind;
  return options;
}

TEST(MemoryFigures, CoverDust) {
  ExpectCovered(&IsDust);
  SkeletonizeOptions prepared;
  prepared.preparing.components = KeptComponents::kLargest;
  ExpectCovered(&IsDust, prepared);
}

TEST(MemoryFigures, CoverNets) {
  for (const int32_t step : {2, 3, 5}) ExpectCovered(Net(step));
}

TEST(MemoryFigures, CoverNoise) {
  for (const uint64_t percent : {5u, 15u, 30u, 45u, 60u, 80u}) ExpectCovered(Noise(percent));
}

TEST(MemoryFigures, CoverEachKindOfSkeleton) {
  for (const IsIn& is_in : {IsIn(&IsDust), Net(2), Noise(30), Noise(60)}) {
    ExpectCovered(is_in, Options(SkeletonKind::kSurface));
    ExpectCovered(is_in, Options(SkeletonKind::kIsthmusCurve));
    SkeletonizeOptions directional;
    directional.thinning.method = ThinningMethod::kDirectional;
    directional.distance = DistanceKind::kChamfer;
    ExpectCovered(is_in, directional);
  }
}

}  // namespace
}  // namespace bccskel::server
