#include "client/operations.h"

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <utility>

#include "bccskel/v1/admin_service.grpc.pb.h"
#include "client/channel.h"
#include "client/grpc_attempt.h"
#include "client/grpc_status.h"
#include "core/exec/status_macros.h"

namespace bccskel::client {
namespace {

using std::chrono::milliseconds;

RetryLoop::Limits Within(milliseconds timeout, const std::stop_token& stop) {
  return {stop, std::chrono::system_clock::now() + timeout};
}

std::chrono::nanoseconds TimeOf(const google::protobuf::Duration& message) {
  return std::chrono::seconds(message.seconds()) + std::chrono::nanoseconds(message.nanos());
}

// grpc.health.v1.HealthCheckRequest{service}: one string.
grpc::ByteBuffer HealthRequest(const std::string& service) {
  std::string bytes = {'\x0a', static_cast<char>(service.size())};
  const grpc::Slice slice(bytes += service);
  return grpc::ByteBuffer(&slice, 1);
}

// HealthCheckResponse{status}: one number, 1 for SERVING.
bool IsServing(const grpc::ByteBuffer& response) {
  grpc::Slice bytes;
  return response.DumpToSingleSlice(&bytes).ok() && bytes.size() == 2 && bytes.begin()[0] == 8 &&
         bytes.begin()[1] == 1;
}

// A unary call whose messages are bytes.
grpc::Status Call(grpc::GenericStub& stub, const char* method, grpc::ClientContext& context,
                  const grpc::ByteBuffer& request, grpc::ByteBuffer& response) {
  grpc::CompletionQueue queue;
  const auto call = stub.PrepareUnaryCall(&context, method, request, &queue);
  call->StartCall();
  grpc::Status status;
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);  // ends by the deadline
  return status;
}

std::optional<ServerStatus::Stored> StoredOf(const v1::GetServerStatusResponse& message) {
  if (!message.has_stored()) return std::nullopt;
  return ServerStatus::Stored{.disk_used_bytes = message.stored().disk_used_bytes(),
                              .disk_available_bytes = message.stored().disk_available_bytes(),
                              .unfinished_uploads = message.stored().uploads_unfinished(),
                              .queued_jobs = message.stored().jobs_queued(),
                              .running_jobs = message.stored().jobs_running()};
}

ServerStatus StatusFromMessage(const v1::GetServerStatusResponse& message) {
  ServerStatus status;
  status.server_version = message.server_version();
  status.uptime = TimeOf(message.uptime());
  status.draining = message.draining();
  status.admitted_jobs = message.jobs().admitted();
  status.waiting_jobs = message.jobs().waiting();
  status.running_jobs = message.jobs().running();
  status.threads = message.threads();
  status.busy_threads = message.busy_threads();
  status.admitted_bytes = message.admitted_bytes();
  status.max_admitted_bytes = message.max_admitted_bytes();
  status.resident_bytes = message.resident_bytes();
  status.open_files = message.open_files();
  status.processor_time = TimeOf(message.processor_time());
  status.calls = message.totals().calls();
  status.failed_calls = message.totals().failed_calls();
  status.jobs = message.totals().jobs();
  status.failed_jobs = message.totals().failed_jobs();
  status.object_points = message.totals().object_points();
  status.stored = StoredOf(message);
  return status;
}

}  // namespace

class Operations::Stubs {
 public:
  explicit Stubs(const std::shared_ptr<grpc::Channel>& opened)
      : channel(opened), health(channel), admin(v1::AdminService::NewStub(channel)) {}

  std::shared_ptr<grpc::Channel> channel;
  grpc::GenericStub health;
  std::unique_ptr<v1::AdminService::StubInterface> admin;
};

Operations::Operations(std::unique_ptr<Stubs> stubs) : stubs_(std::move(stubs)) {}
Operations::~Operations() = default;

absl::StatusOr<std::unique_ptr<Operations>> Operations::Create(const Endpoint& endpoint) {
  BCCSKEL_ASSIGN_OR_RETURN(std::shared_ptr<grpc::Channel> channel, OpenChannel(endpoint));
  return std::unique_ptr<Operations>(new Operations(std::make_unique<Stubs>(channel)));
}

absl::Status Operations::CheckHealth(const std::string& service, milliseconds timeout,
                                     const std::stop_token& stop) {
  constexpr size_t kLongestName = 127;  // longer names would need two bytes for their size
  if (service.size() > kLongestName) return absl::NotFoundError("no service has such a long name");
  grpc::ByteBuffer response;
  BCCSKEL_RETURN_IF_ERROR(
      Attempt(*stubs_->channel, Within(timeout, stop), [&](grpc::ClientContext& context) {
        return FromGrpcStatus(Call(stubs_->health, "/grpc.health.v1.Health/Check", context,
                                   HealthRequest(service), response));
      }));
  if (IsServing(response)) return absl::OkStatus();
  return absl::UnavailableError("accepts no calls now (NOT_SERVING)");
}

absl::StatusOr<ServerStatus> Operations::GetStatus(milliseconds timeout,
                                                   const std::stop_token& stop) {
  v1::GetServerStatusResponse response;
  const absl::Status status =
      Attempt(*stubs_->channel, Within(timeout, stop), [&](grpc::ClientContext& context) {
        return FromGrpcStatus(stubs_->admin->GetServerStatus(&context, {}, &response));
      });
  if (absl::IsUnimplemented(status)) {
    return absl::UnimplementedError(
        "accepts no admin calls here: they are at the address that the server was given as "
        "--admin-listen");
  }
  if (!status.ok()) return status;
  return StatusFromMessage(response);
}

}  // namespace bccskel::client
