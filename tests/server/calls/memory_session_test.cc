#include "server/calls/memory_session.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>
#include <utility>

#include "proto/wire/error_details.h"
#include "server/calls/services.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// The handler against a job that does what the test says.

namespace bccskel::server {
namespace {

class FakeJob : public Job {
 public:
  explicit FakeJob(std::shared_ptr<JobListener> listener) : listener_(std::move(listener)) {}
  const std::string& name() const override { return name_; }
  void Append(std::string bytes) override {
    bytes_ += bytes;
    appended_.release();
  }
  void FinishVolume(std::optional<Sha256Digest>) override { finished_.release(); }
  void EndWith(absl::Status) override { cancelled_.release(); }

  JobListener& listener() { return *listener_; }
  void WaitForBytes() { appended_.acquire(); }
  void WaitForFinish() { finished_.acquire(); }
  void WaitForCancel() { cancelled_.acquire(); }
  bool HasMoreBytes() { return appended_.try_acquire(); }

 private:
  const std::string name_ = "jobs/fake";
  std::shared_ptr<JobListener> listener_;
  std::string bytes_;
  std::counting_semaphore<1000> appended_{0}, finished_{0}, cancelled_{0};
};

class FakeRunner : public JobRunner {
 public:
  absl::StatusOr<std::shared_ptr<Job>> Start(JobRequest,
                                             std::shared_ptr<JobListener> listener) override {
    job_ = std::make_shared<FakeJob>(std::move(listener));
    if (on_start) on_start(job_->listener());
    started_.release();
    return job_;
  }
  absl::StatusOr<std::shared_ptr<Job>> Start(LabelsRequest,
                                             std::shared_ptr<LabelsListener>) override {
    return absl::UnimplementedError("not needed here");
  }
  std::shared_ptr<FakeJob> WaitForJob() {
    started_.acquire();
    return job_;
  }

  std::function<void(JobListener&)> on_start;  // called before the job is accepted

 private:
  std::shared_ptr<FakeJob> job_;
  std::binary_semaphore started_{0};
};

class MemorySessionTest : public testing::Test {
 protected:
  MemorySessionTest() {
    int port = 0;
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(service_.get());
    server_ = builder.BuildAndStart();
    channel_ = test::ConnectTo("127.0.0.1:" + std::to_string(port));
  }

  FakeRunner runner_;
  const std::unique_ptr<Callers> callers_ = *Callers::Create("");
  const CallGate gate_{*callers_};
  UploadWriters writers_;
  const std::unique_ptr<grpc::Service> service_ =
      MakeSkeletonizationService(gate_, runner_, VolumeLimits(), writers_);
  std::unique_ptr<grpc::Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
};

JobResult AResult() {
  JobResult result;
  result.skeleton = *Skeletonize(test::SmallTorus(), {}, exec::Context());
  return result;
}

TEST_F(MemorySessionTest, DoesNotReadOnBeforeTheChunkBeforeIsConsumed) {
  test::RawCall call(channel_);
  for (const auto& request : RequestsFor(test::SmallTorusPlanes(), 10'000)) {
    ASSERT_TRUE(call.Send(request));
  }
  const auto job = runner_.WaitForJob();
  job->WaitForBytes();
  EXPECT_FALSE(job->HasMoreBytes());
  job->listener().OnBytesConsumed();
  job->WaitForBytes();
  EXPECT_FALSE(job->HasMoreBytes());
  job->listener().OnEnd(absl::CancelledError("enough"));
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kCancelled);
}

TEST_F(MemorySessionTest, ASlowReaderHoldsUpNobodyAndHearsTheNewest) {
  test::RawCall call(channel_);
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  const auto job = runner_.WaitForJob();
  constexpr int kShells = 300'000;
  for (int shell = 1; shell <= kShells; ++shell) {  // nothing is read meanwhile, nothing blocks
    job->listener().OnShell({.shell = shell, .last_shell = kShells},
                            std::chrono::milliseconds(shell));
  }
  job->listener().OnEnd(AResult());
  int heard = 0, newest = 0;
  bool summary = false;
  while (auto response = call.Receive()) {
    summary = response->has_summary();
    if (!response->has_shell_progress()) continue;
    ++heard;
    EXPECT_GT(response->shell_progress().shell(), newest);
    newest = response->shell_progress().shell();
  }
  EXPECT_TRUE(summary);
  EXPECT_EQ(newest, kShells);
  EXPECT_LT(heard, kShells / 2);
  EXPECT_TRUE(call.Finish().ok());
}

TEST_F(MemorySessionTest, AChunkWithAnotherChecksumEndsTheCallAndTheJob) {
  test::RawCall call(channel_);
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  auto chunk = test::ChunkRequest(0, "bytes");
  chunk.mutable_chunk()->set_crc32c(1);
  ASSERT_TRUE(call.Send(chunk));
  const auto job = runner_.WaitForJob();
  job->WaitForCancel();
  EXPECT_FALSE(job->HasMoreBytes());
  job->listener().OnEnd(absl::CancelledError("cancelled"));
  EXPECT_EQ(wire::ErrorInfoOf(call.Finish())->reason(), "CHUNK_CHECKSUM");
}

TEST_F(MemorySessionTest, AFirstResponseWithOthersBehindItArrives) {
  runner_.on_start = [](JobListener& listener) {
    listener.OnShell({.shell = 1, .last_shell = 2}, std::chrono::milliseconds(1));
  };
  test::RawCall call(channel_, std::chrono::seconds(20));
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  const auto first = call.Receive(), second = call.Receive();
  ASSERT_TRUE(first.has_value() && second.has_value()) << call.Finish();
  EXPECT_TRUE(first->has_accepted());
  EXPECT_TRUE(second->has_shell_progress());
}

TEST_F(MemorySessionTest, ACancelledCallCancelsItsJob) {
  test::RawCall call(channel_);
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  const auto job = runner_.WaitForJob();
  call.Cancel();
  job->WaitForCancel();
  job->listener().OnEnd(absl::CancelledError("cancelled"));
  job->listener().OnBytesConsumed();  // may still come; must not touch the ended call
}

TEST_F(MemorySessionTest, AJobsErrorEndsTheCall) {
  test::RawCall call(channel_);
  ASSERT_TRUE(call.Send(ConfigRequest(test::SmallTorusPlanes())));
  runner_.WaitForJob()->listener().OnEnd(absl::ResourceExhaustedError("2 bricks too many"));
  const absl::Status end = call.Finish();
  EXPECT_EQ(end.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(end.message(), "2 bricks too many");
}

TEST_F(MemorySessionTest, ARequestAfterFinishEndsTheCallAndTheJob) {
  test::RawCall call(channel_);
  for (const auto& request : RequestsFor(test::SmallTorusPlanes())) {
    ASSERT_TRUE(call.Send(request));
  }
  ASSERT_TRUE(call.Send(test::ChunkRequest(0, "x")));
  const auto job = runner_.WaitForJob();
  job->WaitForBytes();
  job->listener().OnBytesConsumed();
  job->WaitForFinish();
  job->WaitForCancel();
  job->listener().OnEnd(absl::CancelledError("cancelled"));
  EXPECT_EQ(call.Finish().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel::server
