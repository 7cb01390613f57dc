#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/errors/call_error.h"
#include "server/jobs/job_pool.h"

// Jobs with many labels: turns, pauses, memory.

namespace bccskel::server::labels_job {
namespace {

// Keeps the results until it is told to let go of them.
class Listener : public LabelsListener {
 public:
  void OnBytesConsumed() override {
    std::lock_guard lock(mutex_);
    ++pieces_consumed_;
    changed_.notify_all();
  }
  void OnProgress(uint64_t, uint64_t, std::chrono::nanoseconds) override {}
  void OnLabel(LabelResult result) override {
    std::lock_guard lock(mutex_);
    EXPECT_FALSE(end_.has_value());
    EXPECT_EQ(result.skeleton.label, ++labels_) << "in order";
    kept_.push_back(std::move(result));
    changed_.notify_all();
  }
  void OnEnd(absl::StatusOr<LabelsResult> result) override {
    std::lock_guard lock(mutex_);
    EXPECT_FALSE(end_.has_value()) << "a job ended twice";
    end_ = std::move(result);
    changed_.notify_all();
  }

  void WaitForRoom(int pieces) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return pieces_consumed_ >= pieces || end_.has_value(); });
  }
  // Until a label is there or the job has ended.
  void WaitForLabel() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !kept_.empty() || end_.has_value(); });
  }
  absl::StatusOr<LabelsResult>& WaitForEnd() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return end_.has_value(); });
    return *end_;
  }
  // Lets go of what is kept.
  void LetGo() {
    std::lock_guard lock(mutex_);
    kept_.clear();
  }
  bool ended() {
    std::lock_guard lock(mutex_);
    return end_.has_value();
  }
  uint64_t labels() {
    std::lock_guard lock(mutex_);
    return labels_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int pieces_consumed_ = 0;
  uint64_t labels_ = 0;
  std::vector<LabelResult> kept_;
  std::optional<absl::StatusOr<LabelsResult>> end_;
};

struct Volume8 {
  LabelsRequest request;
  std::string bytes;  // a byte a voxel
};

template <typename LabelAt>
Volume8 VolumeOf(int32_t nx, int32_t ny, int32_t nz, LabelAt label_at) {
  Volume8 volume;
  uint64_t voxels = 0;
  for (int32_t z = 0; z < nz; ++z) {
    for (int32_t y = 0; y < ny; ++y) {
      for (int32_t x = 0; x < nx; ++x) {
        volume.bytes.push_back(static_cast<char>(label_at(x, y, z)));
        if (volume.bytes.back() != 0) ++voxels;
      }
    }
  }
  LabelVolumeHeader header = {.grid = {.nx = nx, .ny = ny, .nz = nz, .placement = {}}};
  header.max_voxels = voxels;
  volume.request.header = WithWorstCase(header, 0);
  volume.request.size_bytes = volume.bytes.size();
  return volume;
}

// Nets of 65 x 65 voxels, a slice each, whose graphs take more than their voxels.
Volume8 Nets(int32_t count) {
  Volume8 nets = VolumeOf(65, 65, count, [](int32_t x, int32_t y, int32_t z) {
    return x % 2 == 0 || y % 2 == 0 ? z + 1 : 0;
  });
  nets.request.header.max_label_voxels = 65 * 65;
  return nets;
}

// Voxels that touch nothing, each with 16 bricks: no declaration of voxels lets expect it.
Volume8 Dust() {
  return VolumeOf(256, 80, 96, [](int32_t x, int32_t y, int32_t z) {
    return x % 32 == 15 && y % 8 == 3 && z % 16 == 7 ? 1 : 0;
  });
}

JobPool::Limits OneThread() {
  return {.threads = 1,
          .max_jobs = 1,
          .max_queue = 4,
          .max_bytes = uint64_t{1} << 30,
          .max_volume_bytes = uint64_t{1} << 30,
          .volume = {}};
}

struct Started {
  std::shared_ptr<Listener> listener = std::make_shared<Listener>();
  std::shared_ptr<Job> job;
};

Started StartAndUpload(JobPool& pool, const Volume8& volume) {
  Started started;
  started.job = *pool.Start(volume.request, started.listener);
  int pieces = 0;
  for (size_t offset = 0; offset < volume.bytes.size(); offset += 50'000) {
    started.job->Append(volume.bytes.substr(offset, 50'000));
    started.listener->WaitForRoom(++pieces);
  }
  started.job->FinishVolume(Sha256Of(volume.bytes));
  return started;
}

void WaitForIdle(const JobPool& pool) {
  while (pool.compute_usage() != ComputeQueue::Usage()) std::this_thread::yield();
}

TEST(LabelsJob, PausesWithoutThreadsWhileItsResultsFillItsMemory) {
  JobPool pool(OneThread());
  const Started started = StartAndUpload(pool, Nets(160));
  const uint64_t admitted_bytes = pool.admission_usage().bytes;
  started.listener->WaitForLabel();
  WaitForIdle(pool);
  EXPECT_FALSE(started.listener->ended());
  EXPECT_LT(started.listener->labels(), 160u);
  EXPECT_EQ(pool.admission_usage().places, 1);
  EXPECT_LE(pool.admission_usage().bytes, admitted_bytes);
  while (!started.listener->ended()) {
    started.listener->LetGo();
    std::this_thread::yield();
  }
  const auto& end = started.listener->WaitForEnd();
  ASSERT_TRUE(end.ok()) << end.status();
  EXPECT_EQ(end->labels, 160u);
  EXPECT_EQ(started.listener->labels(), 160u);
}

TEST(LabelsJob, CancelWhilePausedEndsIt) {
  JobPool pool(OneThread());
  const Started started = StartAndUpload(pool, Nets(160));
  started.listener->WaitForLabel();
  WaitForIdle(pool);
  started.job->Cancel();
  EXPECT_TRUE(absl::IsCancelled(started.listener->WaitForEnd().status()));
  EXPECT_EQ(pool.admission_usage(), Admission::Usage());
  started.listener->LetGo();  // must not wake what has ended
  WaitForIdle(pool);
}

TEST(LabelsJob, CancelAtAnyMomentEndsItExactlyOnce) {
  JobPool::Limits limits = OneThread();
  limits.threads = 2;
  JobPool pool(limits);
  const Volume8 nets = Nets(60);
  for (int n = 0; n < 8; ++n) {
    const Started started = StartAndUpload(pool, nets);
    const std::jthread reader([&](std::stop_token stop) {
      while (!stop.stop_requested()) {
        started.listener->LetGo();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(5 * n));
    started.job->Cancel();
    const auto& end = started.listener->WaitForEnd();
    EXPECT_TRUE(end.ok() || absl::IsCancelled(end.status())) << end.status();
  }
  WaitForIdle(pool);
}

TEST(LabelsJob, ResultsThatAreKeptStayAdmittedAfterTheEnd) {
  JobPool pool(OneThread());
  {
    const Started started = StartAndUpload(pool, Nets(5));
    ASSERT_TRUE(started.listener->WaitForEnd().ok());
    WaitForIdle(pool);
    EXPECT_EQ(pool.admission_usage().places, 0);
    EXPECT_GT(pool.admission_usage().bytes, 5u * 1024);
  }
  while (pool.admission_usage() != Admission::Usage()) std::this_thread::yield();
}

TEST(LabelsJob, ThinLabelsAreGivenMoreMemoryWhereThereIsSome) {
  JobPool pool(OneThread());
  const Volume8 dust = Dust();
  const Started started = StartAndUpload(pool, dust);
  const auto& end = started.listener->WaitForEnd();
  ASSERT_TRUE(end.ok()) << end.status();
  EXPECT_EQ(end->labels, 1u);
}

TEST(LabelsJob, ThinLabelsAreRefusedWhereThereIsNoMore) {
  const Volume8 dust = Dust();
  JobPool::Limits limits = OneThread();
  limits.max_bytes = BytesToSkeletonizeLabels(dust.request.header, 1);
  JobPool pool(limits);
  const Started started = StartAndUpload(pool, dust);
  EXPECT_EQ(ReasonOf(started.listener->WaitForEnd().status()), Reason::kVolumeTooLarge);
  EXPECT_EQ(pool.admission_usage(), Admission::Usage());
}

}  // namespace
}  // namespace bccskel::server::labels_job
