#include "core/ranks/checkpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/ranks/rank_skeletonize.h"
#include "core/volume/layer_part.h"
#include "tests/core/ranks/thread_exchange.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

// Of this process; may run out of space after some files.
class MemoryFolder : public ranks::CheckpointFolder {
 public:
  absl::Status Write(const std::string& name, const ranks::Bytes& bytes) override {
    const std::lock_guard lock(mutex_);
    if (room_ == 0) return absl::ResourceExhaustedError("no space left");
    --room_;
    files_[name] = bytes;
    return absl::OkStatus();
  }
  absl::StatusOr<ranks::Bytes> Read(const std::string& name) override {
    const std::lock_guard lock(mutex_);
    const auto found = files_.find(name);
    if (found == files_.end()) return absl::NotFoundError(name);
    return found->second;
  }
  void Remove(const std::string& name) override {
    const std::lock_guard lock(mutex_);
    files_.erase(name);
  }

  void SetRoom(int files) { room_ = files; }
  std::map<std::string, ranks::Bytes>& files() { return files_; }

 private:
  std::mutex mutex_;
  int room_ = 1 << 30;
  std::map<std::string, ranks::Bytes> files_;
};

struct Job {
  int ranks = 1;
  ranks::Resuming resuming = ranks::Resuming::kNever;
  int32_t stop_after = 0;  // shell; 0: never
};

absl::StatusOr<SkeletonizeResult> RunJob(const Job& job, const Volume& object,
                                         const SkeletonizeOptions& options, MemoryFolder& folder) {
  absl::StatusOr<SkeletonizeResult> result = absl::UnknownError("nobody has led");
  const ranks::CheckpointOptions checkpoints = {&folder, job.resuming,
                                                std::chrono::milliseconds(0)};
  ranks::RunAsThreads(job.ranks, [&](ranks::Exchange& exchange) {
    exec::Context context;
    std::stop_source source;
    Volume part = OnlyLayers(object, {exchange.rank(), exchange.size()});
    if (exchange.rank() != 0) {
      (void)ranks::FollowLead(exchange, context, std::move(part), checkpoints);
      return;
    }
    context.stop = source.get_token();
    context.on_shell = [&](const exec::ShellProgress& progress) {
      if (progress.shell == job.stop_after) source.request_stop();
    };
    ranks::Lead lead(exchange, checkpoints);
    result = lead.Skeletonize(part, options, context);
  });
  return result;
}

std::vector<SkeletonizeOptions> AllOptions() {
  std::vector<SkeletonizeOptions> all;
  for (const SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface,
                                  SkeletonKind::kKernel, SkeletonKind::kIsthmusCurve}) {
    all.push_back({.thinning = {.method = ThinningMethod::kSymmetric, .kind = kind}});
  }
  all.push_back({.thinning = {.method = ThinningMethod::kDirectional}});
  all.push_back({.thinning = {.method = ThinningMethod::kDirectionalAlternating}});
  return all;
}

Volume NoisyBlob(uint64_t seed) {
  return VolumeOfPoints(
      test::WithNoisyBoundary(seed, test::RandomBlob(seed, {40, 40, 40}, 8, 14), 0.05));
}

TEST(Checkpoints, AResumedJobGivesTheResultOfOneThatWasNotStopped) {
  const Volume object = NoisyBlob(1);
  for (const SkeletonizeOptions& options : AllOptions()) {
    const auto wanted = Skeletonize(object, options, {});
    for (const int32_t shell : {1, 3, 5}) {
      ASSERT_LT(shell, wanted->last_shell);
      for (const int ranks : {1, 2, 5}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(options.thinning.kind) << " shell "
                                        << shell << " resumed on " << ranks);
        MemoryFolder folder;
        const auto stopped = RunJob({.ranks = 3, .stop_after = shell}, object, options, folder);
        EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled);
        const auto resumed = RunJob({.ranks = ranks, .resuming = ranks::Resuming::kWhereDone},
                                    object, options, folder);
        ASSERT_TRUE(resumed.ok()) << resumed.status();
        EXPECT_EQ(resumed->sha256, wanted->sha256);
        EXPECT_EQ(resumed->thin, wanted->thin);
        EXPECT_EQ(resumed->graph, wanted->graph);
      }
    }
  }
}

TEST(Checkpoints, AResumedJobGoesOnWhereItWas) {
  const Volume object = NoisyBlob(2);
  MemoryFolder folder;
  (void)RunJob({.ranks = 2, .stop_after = 3}, object, {}, folder);
  std::vector<int32_t> shells;
  ranks::RunAsThreads(1, [&](ranks::Exchange& exchange) {
    exec::Context context;
    context.on_shell = [&](const exec::ShellProgress& progress) {
      shells.push_back(progress.shell);
    };
    ranks::Lead lead(exchange, {&folder, ranks::Resuming::kWhereDone});
    Volume part = object;
    ASSERT_TRUE(lead.Skeletonize(part, {}, context).ok());
  });
  EXPECT_GT(shells.front(), 3);
}

TEST(Checkpoints, OnlyTheLastOneStays) {
  MemoryFolder folder;
  ASSERT_TRUE(RunJob({.ranks = 3}, NoisyBlob(3), {}, folder).ok());
  EXPECT_EQ(folder.files().size(), 4u);
}

TEST(Checkpoints, WithoutOneAJobBeginsAnew) {
  const Volume object = NoisyBlob(4);
  MemoryFolder folder;
  const auto result =
      RunJob({.ranks = 2, .resuming = ranks::Resuming::kWhereDone}, object, {}, folder);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->sha256, Skeletonize(object, {}, {})->sha256);
}

TEST(Checkpoints, ThoseOfOtherObjectsOrOptionsAreRefused) {
  MemoryFolder folder;
  ASSERT_TRUE(RunJob({.ranks = 2}, NoisyBlob(5), {}, folder).ok());
  const Job resume = {.ranks = 2, .resuming = ranks::Resuming::kWhereDone};
  EXPECT_EQ(RunJob(resume, NoisyBlob(6), {}, folder).status().code(),
            absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(
      RunJob(resume, NoisyBlob(5), {.thinning = {.method = ThinningMethod::kDirectional}}, folder)
          .status()
          .code(),
      absl::StatusCode::kFailedPrecondition);
}

TEST(Checkpoints, DamageIsSeenOnAllRanks) {
  for (const std::string name : {"checkpoint", "part-2"}) {
    MemoryFolder folder;
    ASSERT_TRUE(RunJob({.ranks = 3}, NoisyBlob(7), {}, folder).ok());
    for (auto& [file, bytes] : folder.files()) {
      if (file.find(name) != std::string::npos) bytes[bytes.size() / 2] ^= std::byte{1};
    }
    const auto result =
        RunJob({.ranks = 2, .resuming = ranks::Resuming::kWhereDone}, NoisyBlob(7), {}, folder);
    EXPECT_EQ(result.status().code(), absl::StatusCode::kFailedPrecondition) << result.status();
    EXPECT_THAT(std::string(result.status().message()), HasSubstr("is damaged"));
  }
}

TEST(Checkpoints, AFullDiskLeavesTheOneBefore) {
  const Volume object = NoisyBlob(8);
  MemoryFolder folder;
  folder.SetRoom(2 * 4 + 1);  // two of three parts and their mark
  const auto full = RunJob({.ranks = 3}, object, {}, folder);
  EXPECT_FALSE(full.ok());
  folder.SetRoom(1000);
  const auto resumed =
      RunJob({.ranks = 2, .resuming = ranks::Resuming::kWhereDone}, object, {}, folder);
  ASSERT_TRUE(resumed.ok()) << resumed.status();
  EXPECT_EQ(resumed->sha256, Skeletonize(object, {}, {})->sha256);
}

}  // namespace
}  // namespace bccskel
