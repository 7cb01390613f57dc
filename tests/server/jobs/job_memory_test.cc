#include "server/jobs/job_memory.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "core/io/volume_encoder.h"
#include "server/errors/call_error.h"
#include "server/jobs/job_pool.h"
#include "tests/support/volume_headers.h"
#include "tests/support/volume_where.h"

namespace bccskel::server {
namespace {

class Listener final : public JobListener {
 public:
  void OnBytesConsumed() override {
    if (!consumed_once_) consumed_.set_value();
    consumed_once_ = true;
  }
  void OnShell(const exec::ShellProgress&, std::chrono::nanoseconds) override {}
  void OnEnd(absl::StatusOr<JobResult> result) override { result_.set_value(std::move(result)); }

  void WaitForRoom() { consumed_.get_future().wait(); }
  absl::StatusOr<JobResult> Result() { return result_.get_future().get(); }

 private:
  bool consumed_once_ = false;
  std::promise<void> consumed_;
  std::promise<absl::StatusOr<JobResult>> result_;
};

struct Encoded {
  JobRequest request;
  std::string bytes;
};

JobPool::Limits Limits(uint64_t max_bytes) {
  return {.threads = 2,
          .max_jobs = 2,
          .max_queue = 2,
          .max_bytes = max_bytes,
          .max_volume_bytes = uint64_t{1} << 30,
          .volume = {}};
}

std::optional<absl::StatusOr<JobResult>> RunJob(JobPool& pool, const Encoded& encoded) {
  const auto listener = std::make_shared<Listener>();
  const std::shared_ptr<Job> job = *pool.Start(encoded.request, listener);
  job->Append(encoded.bytes);
  listener->WaitForRoom();
  job->FinishVolume(std::nullopt);
  return listener->Result();
}

// The last thread of a job lets go of its memory after it told the end.
void WaitFor(const JobPool& pool, uint64_t bytes) {
  while (pool.admission_usage().bytes != bytes) std::this_thread::yield();
}

// Isolated points, 256 in each brick: few bytes and few bricks, and nothing can be thinned.
Volume Dust(int32_t cells) {
  return test::VolumeWhere({cells, cells, cells}, [](int32_t x, int32_t y, int32_t z) {
    return x % 2 == 0 && (x + y + z) % 4 == 0;
  });
}

Encoded Encode(const Volume& volume, const VolumeEncoding& encoding,
               const VolumeCompression& compression) {
  Encoded encoded;
  encoded.bytes = *EncodeVolume(volume, {.encoding = encoding, .compression = compression});
  encoded.request.size_bytes = encoded.bytes.size();
  if (encoding == VolumeEncoding::kRawPlanes) {
    encoded.request.header = *test::MakePlanesHeader(
        volume.extent(), volume.placement(), VolumeLimits(), compression, volume.brick_count());
  } else {
    encoded.request.header =
        *ScanVolumeHeader(encoding, std::as_bytes(std::span(encoded.bytes)), VolumeLimits());
  }
  return encoded;
}

TEST(JobMemory, EndsAJobThatLeavesTooManyPoints) {
  const Volume dust = Dust(64);
  for (const auto& [encoding, compression] :
       {std::pair(VolumeEncoding::kRawPlanes, VolumeCompression::kNone),
        {VolumeEncoding::kRawPlanes, VolumeCompression::kZstd},
        {VolumeEncoding::kOpenExr, VolumeCompression::kRle},
        {VolumeEncoding::kBricks, VolumeCompression::kZstd}}) {
    const Encoded encoded = Encode(dust, encoding, compression);
    JobPool pool(Limits(uint64_t{48} << 20));
    const absl::Status status = RunJob(pool, encoded)->status();
    EXPECT_EQ(ReasonOf(status), Reason::kVolumeTooLarge) << status;
    EXPECT_NE(std::string(status.message()).find("131072 points that thinning leaves"),
              std::string::npos)
        << status;
    WaitFor(pool, 0);
  }
}

TEST(JobMemory, ReservesWhatThePointsTakeUntilTheResultIsLetGoOf) {
  const Encoded encoded = Encode(Dust(32), VolumeEncoding::kRawPlanes, VolumeCompression::kNone);
  JobPool pool(Limits(uint64_t{1} << 30));
  auto result = RunJob(pool, encoded);
  ASSERT_TRUE(result->ok()) << result->status();
  WaitFor(pool, GraphBytes((*result)->skeleton.graph));
  result.reset();
  WaitFor(pool, 0);
}

TEST(JobMemory, KeepsWhatTheJobWasPromisedUntilItsEnd) {
  Admission admission({.bytes = 100, .places = 1});
  JobMemory memory(*admission.Admit("", 60), 60);
  ASSERT_TRUE(memory.SetBase(10).ok());
  ASSERT_TRUE(memory.Take(30, "points").ok());
  EXPECT_EQ(admission.usage().bytes, 60u);
  ASSERT_TRUE(memory.Take(40, "points").ok());
  EXPECT_EQ(admission.usage().bytes, 80u);
  memory.GiveBack(70);
  EXPECT_EQ(admission.usage().bytes, 60u);
  EXPECT_EQ(memory.Close().bytes(), 60u);
}

TEST(JobMemory, AdmitsAJobWithTheBytesThatItAsksFor) {
  Encoded encoded = Encode(Dust(32), VolumeEncoding::kRawPlanes, VolumeCompression::kNone);
  encoded.request.min_bytes = uint64_t{1} << 30;
  JobPool pool(Limits(encoded.request.min_bytes));
  const auto listener = std::make_shared<Listener>();
  const std::shared_ptr<Job> job = *pool.Start(encoded.request, listener);
  EXPECT_EQ(ReasonOf(pool.Start(encoded.request, std::make_shared<Listener>()).status()),
            Reason::kMemoryBusy);
  job->Cancel();
  EXPECT_TRUE(absl::IsCancelled(listener->Result().status()));
}

}  // namespace
}  // namespace bccskel::server
