#include "server/jobs/job_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "server/admission/memory_estimate.h"
#include "server/errors/call_error.h"
#include "tests/support/volume_headers.h"

namespace bccskel::server::job_pool {
namespace {

// Remembers the job's news and lets tests wait for them.
class Listener : public JobListener {
 public:
  // Runs on the job's thread with every shell; a test that blocks in it holds the job at work.
  std::function<void()> on_shell = [] {};
  // The same with every piece of the volume that is decoded.
  std::function<void()> on_bytes_consumed = [] {};

  void OnBytesConsumed() override {
    on_bytes_consumed();
    std::lock_guard lock(mutex_);
    ++pieces_consumed_;
    changed_.notify_all();
  }
  void OnShell(const exec::ShellProgress&, std::chrono::nanoseconds) override { on_shell(); }
  void OnEnd(absl::StatusOr<JobResult> result) override {
    std::lock_guard lock(mutex_);
    EXPECT_FALSE(result_.has_value()) << "a job ended twice";
    result_ = std::move(result);
    changed_.notify_all();
  }

  // Until so many pieces are decoded, or the job has ended.
  void WaitForRoom(int pieces) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return pieces_consumed_ >= pieces || result_.has_value(); });
  }
  absl::StatusOr<JobResult>& WaitForEnd() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return result_.has_value(); });
    return *result_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int pieces_consumed_ = 0;
  std::optional<absl::StatusOr<JobResult>> result_;
};

struct Encoded {
  JobRequest request;
  std::string bytes;
};

Encoded EncodeTorus(uint64_t points) {
  const Volume torus = *GenerateShape(Shape::kTorus, {.points = points});
  Encoded encoded;
  encoded.bytes = *EncodeVolume(torus, {VolumeEncoding::kRawPlanes, VolumeCompression::kNone});
  encoded.request.header = *test::MakePlanesHeader(torus.extent(), torus.placement(), {},
                                                   VolumeCompression::kNone, torus.brick_count());
  encoded.request.size_bytes = encoded.bytes.size();
  return encoded;
}

const Encoded& SmallTorus() {
  static const Encoded torus = EncodeTorus(20'000);
  return torus;
}

JobPool::Limits RoomyLimits() {
  return {.threads = 4,
          .max_jobs = 4,
          .max_queue = 16,
          .max_bytes = uint64_t{4} << 30,
          .max_volume_bytes = uint64_t{1} << 30,
          .volume = {}};
}

constexpr ComputeQueue::Usage kIdle;

void WaitForIdle(const JobPool& pool) {
  while (pool.compute_usage() != kIdle) std::this_thread::yield();
}

// A job's last thread lets go of the listener, and with it of the result, after it told the end.
void WaitUntilAllIsGivenBack(const JobPool& pool) {
  WaitForIdle(pool);
  while (pool.admission_usage() != Admission::Usage()) std::this_thread::yield();
}

void Upload(Job& job, Listener& listener, const std::string& bytes) {
  int pieces = 0;
  for (size_t offset = 0; offset < bytes.size(); offset += 10'000) {
    job.Append(bytes.substr(offset, 10'000));
    listener.WaitForRoom(++pieces);
  }
  job.FinishVolume(Sha256Of(bytes));
}

struct Started {
  std::shared_ptr<Listener> listener = std::make_shared<Listener>();
  std::shared_ptr<Job> job;
};

Started Start(
    JobPool& pool, const Encoded& encoded, std::function<void()> on_shell = [] {}) {
  Started started;
  started.listener->on_shell = std::move(on_shell);
  auto job = pool.Start(encoded.request, started.listener);
  EXPECT_TRUE(job.ok()) << job.status();
  if (job.ok()) started.job = *std::move(job);
  return started;
}

TEST(JobPool, GivesWhatThePipelineGives) {
  JobPool pool(RoomyLimits());
  const Started started = Start(pool, SmallTorus());
  Upload(*started.job, *started.listener, SmallTorus().bytes);
  const auto& result = started.listener->WaitForEnd();
  ASSERT_TRUE(result.ok()) << result.status();
  const Volume torus = *GenerateShape(Shape::kTorus, {.points = 20'000});
  const auto expected = Skeletonize(torus, {}, exec::Context());
  ASSERT_TRUE(expected.ok()) << expected.status();
  EXPECT_EQ(result->skeleton.sha256, expected->sha256);
  EXPECT_EQ(result->skeleton.certificate, expected->certificate);
  EXPECT_EQ(result->skeleton.certificate.skeleton, (BettiNumbers{1, 1, 0}));
  EXPECT_TRUE(result->thin_volume.empty());
}

TEST(JobPool, TellsItsObserverOfEveryJobBeforeItsListener) {
  uint64_t admitted = 0;
  std::vector<JobEnd> ends;
  JobPool pool(RoomyLimits(), {.on_admitted = [&](uint64_t bytes) { admitted += bytes; },
                               .on_end = [&](const JobEnd& end) { ends.push_back(end); }});
  const Started done = Start(pool, SmallTorus());
  Upload(*done.job, *done.listener, SmallTorus().bytes);
  ASSERT_TRUE(done.listener->WaitForEnd().ok());
  ASSERT_EQ(ends.size(), 1U);
  EXPECT_EQ(ends[0].object_points, done.listener->WaitForEnd()->skeleton.object_points);
  EXPECT_GT(ends[0].times.computed.count(), 0);
  const Started left = Start(pool, SmallTorus());
  left.job->EndWith(absl::CancelledError("left"));
  EXPECT_FALSE(left.listener->WaitForEnd().ok());
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[1].status, absl::CancelledError("left"));
  EXPECT_EQ(admitted, 2 * SmallTorus().request.size_bytes);
}

TEST(JobPool, EncodesTheThinVolumeWhereItIsWanted) {
  Encoded encoded = SmallTorus();
  encoded.request.thin_volume = VolumeEncoding::kBricks;
  JobPool pool(RoomyLimits());
  const Started started = Start(pool, encoded);
  Upload(*started.job, *started.listener, encoded.bytes);
  const auto& result = started.listener->WaitForEnd();
  ASSERT_TRUE(result.ok()) << result.status();
  const auto thin = DecodeVolume(VolumeEncoding::kBricks, result->thin_volume);
  ASSERT_TRUE(thin.ok()) << thin.status();
  EXPECT_EQ(thin->PointCount(), result->skeleton.skeleton_points);
}

TEST(JobPool, ManyJobsAtOnceGiveOneDigest) {
  JobPool pool(RoomyLimits());
  std::vector<std::string> digests(8);
  {
    std::vector<std::jthread> callers;
    for (std::string& digest : digests) {
      callers.emplace_back([&pool, &digest] {
        const Started started = Start(pool, SmallTorus());
        Upload(*started.job, *started.listener, SmallTorus().bytes);
        digest = started.listener->WaitForEnd()->skeleton.sha256;
      });
    }
  }
  for (const std::string& digest : digests) EXPECT_EQ(digest, digests[0]);
}

TEST(JobPool, AJobWhoseHandleIsDroppedGoesOn) {
  JobPool pool(RoomyLimits());
  Started started = Start(pool, SmallTorus());
  Upload(*started.job, *started.listener, SmallTorus().bytes);
  started.job.reset();
  EXPECT_TRUE(started.listener->WaitForEnd().ok());
}

TEST(JobPool, AResultKeepsItsMemoryAdmittedButNoPlace) {
  JobPool pool(RoomyLimits());
  {
    const Started started = Start(pool, SmallTorus());
    EXPECT_EQ(pool.admission_usage().places, 1);
    EXPECT_EQ(pool.admission_usage().bytes,
              BytesToSkeletonize(SmallTorus().request.header, SmallTorus().bytes.size()));
    Upload(*started.job, *started.listener, SmallTorus().bytes);
    ASSERT_TRUE(started.listener->WaitForEnd().ok());
    EXPECT_EQ(pool.admission_usage().places, 0);
    EXPECT_GT(pool.admission_usage().bytes, 0u);
    EXPECT_LT(pool.admission_usage().bytes, uint64_t{1} << 20);
  }
  WaitUntilAllIsGivenBack(pool);
}

TEST(JobPool, CancelWhileReceivingFreesThePlace) {
  JobPool pool(RoomyLimits());
  const Started started = Start(pool, SmallTorus());
  started.job->Append(SmallTorus().bytes.substr(0, 100));
  started.listener->WaitForRoom(1);
  started.job->Cancel();
  EXPECT_EQ(started.listener->WaitForEnd().status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(pool.admission_usage(), Admission::Usage());
  started.job->Append("ignored");
  started.job->FinishVolume(std::nullopt);
  started.job->Cancel();
}

TEST(JobPool, CancelWhileComputingFreesThreadsAndMemory) {
  JobPool pool(RoomyLimits());
  const Encoded large = EncodeTorus(1'500'000);
  std::binary_semaphore at_work(0), go_on(0);
  std::once_flag once;
  const Started started = Start(pool, large, [&] {
    std::call_once(once, [&] {
      at_work.release();
      go_on.acquire();
    });
  });
  Upload(*started.job, *started.listener, large.bytes);
  at_work.acquire();
  EXPECT_EQ(pool.compute_usage(),
            (ComputeQueue::Usage{.waiting = 0, .running = 1, .busy_threads = 4}));
  started.job->Cancel();
  go_on.release();
  EXPECT_EQ(started.listener->WaitForEnd().status().code(), absl::StatusCode::kCancelled);
  WaitForIdle(pool);
  EXPECT_EQ(pool.admission_usage(), Admission::Usage());
}

TEST(JobPool, CancelWhileWaitingNeverRunsTheJob) {
  JobPool::Limits limits = RoomyLimits();
  limits.threads = limits.max_jobs = 1;
  JobPool pool(limits);
  std::binary_semaphore at_work(0), go_on(0);
  std::once_flag once;
  const Started first = Start(pool, SmallTorus(), [&] {
    std::call_once(once, [&] {
      at_work.release();
      go_on.acquire();
    });
  });
  Upload(*first.job, *first.listener, SmallTorus().bytes);
  at_work.acquire();
  const Started second = Start(pool, SmallTorus(), [] { ADD_FAILURE() << "it ran"; });
  Upload(*second.job, *second.listener, SmallTorus().bytes);
  while (pool.compute_usage().waiting == 0) std::this_thread::yield();
  second.job->Cancel();
  EXPECT_EQ(second.listener->WaitForEnd().status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(pool.admission_usage().places, 1);
  go_on.release();
  EXPECT_TRUE(first.listener->WaitForEnd().ok());
}

TEST(JobPool, CancelAfterTheEndChangesNothing) {
  JobPool pool(RoomyLimits());
  const Started started = Start(pool, SmallTorus());
  Upload(*started.job, *started.listener, SmallTorus().bytes);
  EXPECT_TRUE(started.listener->WaitForEnd().ok());
  started.job->Cancel();
  EXPECT_TRUE(started.listener->WaitForEnd().ok());
}

// Cancels its job with the `moment`-th piece of news about it.
class CancellingListener : public Listener {
 public:
  explicit CancellingListener(int moment) {
    on_shell = on_bytes_consumed = [this, moment] {
      if (news_++ == moment) job->Cancel();
    };
  }
  int news() const { return news_; }

  std::shared_ptr<Job> job;  // set before there are news

 private:
  std::atomic<int> news_ = 0;
};

absl::Status EndWhenCancelledAt(JobPool& pool, int moment) {
  const auto listener = std::make_shared<CancellingListener>(moment);
  listener->job = *pool.Start(SmallTorus().request, listener);
  Upload(*listener->job, *listener, SmallTorus().bytes);
  const absl::Status end = listener->WaitForEnd().status();
  EXPECT_EQ(end.ok(), listener->news() <= moment) << "moment " << moment;
  return end;
}

TEST(JobPool, CancelWithAnyPieceOfNewsEndsAJobAsCancelled) {
  JobPool pool(RoomyLimits());
  int moment = 0;
  absl::Status end = EndWhenCancelledAt(pool, moment);
  for (; !end.ok(); end = EndWhenCancelledAt(pool, ++moment)) {
    EXPECT_EQ(end.code(), absl::StatusCode::kCancelled) << "moment " << moment;
  }
  EXPECT_GT(moment, 10);
  WaitUntilAllIsGivenBack(pool);
}

std::chrono::nanoseconds WholeTime(JobPool& pool) {
  const auto start = std::chrono::steady_clock::now();
  const Started started = Start(pool, SmallTorus());
  Upload(*started.job, *started.listener, SmallTorus().bytes);
  EXPECT_TRUE(started.listener->WaitForEnd().ok());
  return std::chrono::steady_clock::now() - start;
}

absl::Status EndWhenCancelledAfter(JobPool& pool, std::chrono::nanoseconds delay) {
  const Started started = Start(pool, SmallTorus());
  const std::jthread canceller([job = started.job, delay] {
    std::this_thread::sleep_for(delay);
    job->Cancel();
  });
  Upload(*started.job, *started.listener, SmallTorus().bytes);
  return started.listener->WaitForEnd().status();
}

TEST(JobPool, CancelAtAnyMomentEndsAJobExactlyOnce) {
  JobPool pool(RoomyLimits());
  const std::chrono::nanoseconds whole = WholeTime(pool);
  for (int n = 0; n < 60; ++n) {
    const absl::Status end = EndWhenCancelledAfter(pool, whole * n / 40);
    EXPECT_TRUE(end.ok() || absl::IsCancelled(end)) << end;
  }
  WaitUntilAllIsGivenBack(pool);
}

TEST(JobPool, APassedDeadlineIsDeadlineExceeded) {
  JobPool pool(RoomyLimits());
  Encoded encoded = SmallTorus();
  encoded.request.deadline = exec::Context::Clock::now();
  const Started started = Start(pool, encoded);
  started.job->Append(encoded.bytes);
  EXPECT_EQ(started.listener->WaitForEnd().status().code(), absl::StatusCode::kDeadlineExceeded);
}

TEST(JobPool, MalformedBytesAreAnInvalidArgumentAndFreeThePlace) {
  JobPool pool(RoomyLimits());
  Encoded encoded = SmallTorus();
  encoded.request.header.encoding = VolumeEncoding::kOpenExr;
  const Started started = Start(pool, encoded);
  started.job->Append(encoded.bytes);
  EXPECT_EQ(started.listener->WaitForEnd().status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(pool.admission_usage(), Admission::Usage());
}

TEST(JobPool, RefusesWhatIsOverItsLimits) {
  JobPool::Limits limits = RoomyLimits();
  limits.max_volume_bytes = 10;
  JobPool small(limits);
  EXPECT_EQ(ReasonOf(small.Start(SmallTorus().request, std::make_shared<Listener>()).status()),
            Reason::kVolumeTooLarge);
  limits = RoomyLimits();
  limits.max_bytes = 1000;
  JobPool poor(limits);
  EXPECT_EQ(ReasonOf(poor.Start(SmallTorus().request, std::make_shared<Listener>()).status()),
            Reason::kVolumeTooLarge);
}

TEST(JobPool, RefusesForNowWhenTheQueueIsFull) {
  JobPool::Limits limits = RoomyLimits();
  limits.max_jobs = 1;
  limits.max_queue = 1;
  JobPool pool(limits);
  const Started first = Start(pool, SmallTorus()), second = Start(pool, SmallTorus());
  EXPECT_EQ(ReasonOf(pool.Start(SmallTorus().request, std::make_shared<Listener>()).status()),
            Reason::kQueueFull);
  first.job->Cancel();
  first.listener->WaitForEnd();
  const Started third = Start(pool, SmallTorus());
  second.job->Cancel();
  third.job->Cancel();
}

}  // namespace
}  // namespace bccskel::server::job_pool
