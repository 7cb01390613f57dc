#include "server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>

#include <chrono>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/logging/json_log.h"
#include "server/service/server_service.h"
#include "server/service/skeletonization_service.h"

namespace bccskel::server {
namespace {

constexpr char kUnixPrefix[] = "unix:";
// Clients may ping every 10 s, also between calls; more often than that is abuse.
constexpr int kMinPingIntervalMs = 10'000;
// For calls that hold no job, such as a watched health status, to end by themselves.
constexpr std::chrono::milliseconds kLastReplies(100);

void EnableHealthAndReflection() {
  static std::once_flag once;
  std::call_once(once, [] {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  });
}

void Configure(grpc::ServerBuilder& builder) {
  builder.SetMaxReceiveMessageSize(kMaxMessageBytes);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);  // a second server must fail, not share
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             kMinPingIntervalMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
}

// Nothing where it is no Unix socket.
std::optional<std::string> SocketPathOf(const std::string& listen) {
  if (listen.rfind(kUnixPrefix, 0) != 0) return std::nullopt;
  const std::string path = listen.substr(std::strlen(kUnixPrefix));
  return path.rfind("//", 0) == 0 ? path.substr(2) : path;  // unix:/path or unix:///path
}

std::string AddressOf(const std::string& listen, int port) {
  if (SocketPathOf(listen).has_value()) return listen;
  return absl::StrCat(listen.substr(0, listen.rfind(':')), ":", port);
}

}  // namespace

class Server::Listener {
 public:
  Listener(JobPool& jobs, const JobPool::Limits& limits)
      : skeletonization_(gate_, jobs, limits.volume), server_service_(gate_, limits) {}

  // The port, 1 for a Unix socket, 0 where the address cannot be listened on.
  int Listen(const std::string& address) {
    EnableHealthAndReflection();
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&skeletonization_);
    builder.RegisterService(&server_service_);
    Configure(builder);
    server_ = builder.BuildAndStart();
    if (server_ == nullptr) return 0;
    SetServing(Serving::kYes);
    return port;
  }

  enum class Serving { kYes, kNo };
  void SetServing(Serving serving) {
    grpc::HealthCheckServiceInterface& health = *server_->GetHealthCheckService();
    const bool yes = serving == Serving::kYes;
    health.SetServingStatus(yes);
    health.SetServingStatus(v1::SkeletonizationService::service_full_name(), yes);
    health.SetServingStatus(v1::ServerService::service_full_name(), yes);
  }

  void Shutdown(std::chrono::milliseconds grace) {
    if (server_ != nullptr) server_->Shutdown(std::chrono::system_clock::now() + grace);
  }

 private:
  CallGate gate_;
  SkeletonizationService skeletonization_;
  ServerService server_service_;
  std::unique_ptr<grpc::Server> server_;
};

Server::Server(const ServerConfig& config) : config_(config), jobs_(config.limits) {}

Server::~Server() {
  if (listener_ != nullptr) listener_->Shutdown(std::chrono::milliseconds(0));
}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerConfig& config) {
  std::unique_ptr<Server> server(new Server(config));
  BCCSKEL_RETURN_IF_ERROR(server->Listen());
  return server;
}

absl::Status Server::Listen() {
  BCCSKEL_RETURN_IF_ERROR(LockSocket());
  listener_ = std::make_unique<Listener>(jobs_, config_.limits);
  const int port = listener_->Listen(config_.listen);
  if (port == 0) {
    return absl::InvalidArgumentError(absl::StrCat("cannot listen on ", config_.listen));
  }
  address_ = AddressOf(config_.listen, port);
  Log(LogLevel::kInfo, "listening", {{"address", address_}});
  return absl::OkStatus();
}

absl::Status Server::LockSocket() {
  const std::optional<std::string> path = SocketPathOf(config_.listen);
  if (!path.has_value()) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(SocketLock lock, SocketLock::Take(*path));
  socket_lock_.emplace(std::move(lock));
  return absl::OkStatus();
}

void Server::Drain() {
  Log(LogLevel::kInfo, "draining", {{"jobs", int64_t{jobs_.admission_usage().places}}});
  listener_->SetServing(Listener::Serving::kNo);
  jobs_.StopAdmitting();
  std::this_thread::sleep_for(config_.lame_duck);
  jobs_.WaitUntilEmpty(config_.drain);
  listener_->Shutdown(kLastReplies);
  Log(LogLevel::kInfo, "drained");
}

}  // namespace bccskel::server
