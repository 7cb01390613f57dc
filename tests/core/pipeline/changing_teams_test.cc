// What a server does to a job while it runs: its team shrinks and grows, small jobs run on its
// thread in between, and it is cancelled.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <random>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/status.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_graph.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

Volume Ring(int32_t radius, int32_t thickness, int32_t height) {
  const int32_t middle = radius + thickness + 4;
  const auto is_in = [=](int32_t x, int32_t y, int32_t z) {
    const double across = std::hypot(x - middle, y - middle) - radius;
    const double up = static_cast<double>(z) / height - thickness - 4;
    return std::hypot(across, up) < thickness;
  };
  return test::VolumeWhere({2 * middle, 2 * middle, 2 * (thickness + 4) * height}, is_in);
}

std::string DigestOf(const Volume& object, const SkeletonizeOptions& options) {
  return *SkeletonDigest(Skeletonize(object, options, {})->graph);
}

// A context whose turns of events come after random numbers of calls.
class Busy : public test::TeamContext {
 public:
  explicit Busy(std::mt19937& random) : TeamContext(2 + static_cast<int>(random() % 4)) {
    constexpr std::array kPatience = {1e9, 1e9, -1e9, 0.2};
    patience = kPatience[random() % kPatience.size()];
    const auto call = [&] { return random() % 2 == 0 ? random() % 4000 : kNever; };
    shrink_ = call();
    grow_ = shrink_ + random() % 1000;
    cancel_ = random() % 2 == 0 ? call() : kNever;
    visit_ = call();
    stop = source_.get_token();
    share = [this] { return alone_ ? 1 : threads(); };
    yield = [this] { Count(); };
  }

 private:
  static constexpr uint64_t kNever = UINT64_MAX;

  void Count() {
    if (std::this_thread::get_id() != owner_ || visited_) return;
    const uint64_t call = calls_++;
    if (call == shrink_) alone_ = true;
    if (call == grow_) alone_ = false;
    if (call == cancel_) source_.request_stop();
    if (call % 1000 != visit_ % 1000 || visit_ == kNever) return;
    visited_ = true;
    static const Volume small = Ring(12, 5, 1);
    static const std::string digest = DigestOf(small, {});
    EXPECT_EQ(DigestOf(small, {}), digest);
    visited_ = false;
  }

  const std::thread::id owner_ = std::this_thread::get_id();
  std::stop_source source_;
  std::atomic<bool> alone_ = false;
  bool visited_ = false;
  uint64_t calls_ = 0, shrink_ = kNever, grow_ = kNever, cancel_ = kNever, visit_ = kNever;
};

TEST(ChangingTeams, GiveTheSameBits) {
  std::vector<Volume> objects;
  objects.push_back(Ring(24, 8, 1));
  objects.push_back(Ring(16, 8, 10));
  objects.push_back(VolumeOfPoints(test::RandomBlob(13, {40, 40, 160}, 6, 60)));
  std::vector<SkeletonizeOptions> methods(4);
  methods[1].thinning.method = ThinningMethod::kDirectional;
  methods[2].thinning.kind = SkeletonKind::kSurface;
  methods[3].source = ObjectSource::kVoxels;
  std::mt19937 random(1);
  int ended = 0;
  for (const Volume& object : objects) {
    for (const SkeletonizeOptions& options : methods) {
      const std::string digest = DigestOf(object, options);
      for (int n = 0; n < 6; ++n) {
        Busy context(random);
        const auto result = Skeletonize(object, options, context);
        if (!result.ok()) {
          EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
          continue;
        }
        EXPECT_EQ(*SkeletonDigest(result->graph), digest);
        ++ended;
      }
    }
  }
  EXPECT_GT(ended, 36);
}

}  // namespace
}  // namespace bccskel
