#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stop_token>
#include <string>

#include "bccskel/v1/job_service.grpc.pb.h"
#include "client/durable_client.h"
#include "client/grpc_status.h"

namespace bccskel::client {
namespace {

// Cancels the first calls without a word, as gRPC does while a server stops.
class StoppingServer final : public v1::JobService::Service {
 public:
  explicit StoppingServer(int cancelled) : cancelled_(cancelled) {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
    address_ = "127.0.0.1:" + std::to_string(port);
  }
  const std::string& address() const { return address_; }

  grpc::Status GetJob(grpc::ServerContext*, const v1::GetJobRequest* request,
                      v1::GetJobResponse* response) override {
    response->mutable_job()->set_name(request->job());
    return cancelled_-- > 0 ? grpc::Status::CANCELLED : grpc::Status::OK;
  }
  grpc::Status WatchJob(grpc::ServerContext*, const v1::WatchJobRequest*,
                        grpc::ServerWriter<v1::WatchJobResponse>* writer) override {
    if (cancelled_-- > 0) return grpc::Status::CANCELLED;
    v1::WatchJobResponse end;
    end.set_sequence(1);
    end.mutable_state_change()->set_state(v1::JOB_STATE_SUCCEEDED);
    writer->Write(end);
    return grpc::Status::OK;
  }

 private:
  std::atomic<int> cancelled_;
  std::string address_;
  std::unique_ptr<grpc::Server> server_;
};

DurableClient ClientOf(const StoppingServer& server) {
  Endpoint endpoint;
  endpoint.address = server.address();
  return DurableClient(*MakeGrpcDurableStub(endpoint), {},
                       [](std::chrono::milliseconds, const std::stop_token&) {});
}

TEST(GrpcDurableStubTest, TriesAgainAfterACancelThatNobodyHereWanted) {
  const StoppingServer server(2);
  const auto job = ClientOf(server).GetJob("jobs/1", {});
  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(job->name, "jobs/1");
}

TEST(GrpcDurableStubTest, WatchesOnAfterACancelThatNobodyHereWanted) {
  const StoppingServer server(2);
  const auto state = ClientOf(server).Watch("jobs/1", {}, {});
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(*state, JobState::kSucceeded);
}

TEST(GrpcDurableStubTest, ACancelThatWasWantedStaysOne) {
  const absl::Status cancelled = absl::CancelledError("the call was cancelled");
  std::stop_source stop;
  EXPECT_TRUE(absl::IsUnavailable(WithoutForeignCancel(cancelled, stop.get_token())));
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled(WithoutForeignCancel(cancelled, stop.get_token())));
}

}  // namespace
}  // namespace bccskel::client
