#include "server/listener.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>

#include <mutex>
#include <utility>

#include "core/exec/status_macros.h"
#include "proto/address/address.h"
#include "server/calls/services.h"
#include "server/metrics/call_meter.h"

namespace bccskel::server {
namespace {

using grpc::experimental::ExternalConnectionAcceptor;
using ExternalConnectionType = grpc::ServerBuilder::experimental_type::ExternalConnectionType;

// Clients may ping every 10 s, also between calls; more often is abuse.
constexpr int kMinPingIntervalMs = 10'000;
// These detect clients that have vanished.
constexpr int kPingIntervalMs = 60'000, kPingTimeoutMs = 20'000;
// Time for a new connection to start HTTP/2.
constexpr int kHandshakeMs = 20'000;

// gRPC adds reflection, its only plug-in here, to all servers of the process; this removes it.
class WithoutReflection : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    plugins->clear();
  }
};

void Configure(grpc::ServerBuilder& builder) {
  builder.SetMaxReceiveMessageSize(kMaxMessageBytes);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             kMinPingIntervalMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kPingIntervalMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kPingTimeoutMs);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMs);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Listener>> Listener::Start(ListenerPlan plan) {
  static std::once_flag once;
  std::call_once(once, [] {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  });
  std::unique_ptr<Listener> listener(new Listener);
  BCCSKEL_RETURN_IF_ERROR(listener->Listen(plan.addresses));
  BCCSKEL_RETURN_IF_ERROR(listener->Serve(plan));
  listener->healthy_ = std::move(plan.healthy);
  listener->SetServing(Serving::kYes);
  return listener;
}

absl::Status Listener::Listen(const std::vector<std::string>& addresses) {
  for (const std::string& address : addresses) {
    if (const std::string path = SocketPathOf(address); !path.empty()) {
      BCCSKEL_ASSIGN_OR_RETURN(SocketLock lock, SocketLock::Take(path));
      locks_.push_back(std::move(lock));
    }
    BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<ConnectionAcceptor> acceptor,
                             ConnectionAcceptor::Listen(address));
    addresses_.push_back(acceptor->address());
    acceptors_.push_back(std::move(acceptor));
  }
  return absl::OkStatus();
}

absl::Status Listener::Serve(ListenerPlan& plan) {
  grpc::ServerBuilder builder;
  std::vector<std::unique_ptr<ExternalConnectionAcceptor>> takers;
  for (const std::string& address : addresses_) {
    const bool secure = plan.tls != nullptr && SocketPathOf(address).empty();
    takers.push_back(builder.experimental().AddExternalConnectionAcceptor(
        ExternalConnectionType::FROM_FD,
        secure ? plan.tls->CredentialsOfAddress() : grpc::InsecureServerCredentials()));
  }
  for (grpc::Service* service : plan.services) builder.RegisterService(service);
  if (plan.reflection == ListenerPlan::Reflection::kOff) {
    builder.SetOption(std::make_unique<WithoutReflection>());
  }
  Configure(builder);
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> meters;
  meters.push_back(MakeCallMeter(plan.healthy, plan.metrics));
  builder.experimental().SetInterceptorCreators(std::move(meters));
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) return absl::InternalError("gRPC cannot start a server");
  for (size_t n = 0; n < takers.size(); ++n) {
    acceptors_[n]->Start([taker = std::shared_ptr(std::move(takers[n]))](int from, int connection) {
      ExternalConnectionAcceptor::NewConnectionParameters parameters;
      parameters.listener_fd = from;
      parameters.fd = connection;
      taker->HandleNewConnection(&parameters);
    });
  }
  return absl::OkStatus();
}

void Listener::SetServing(Serving serving) {
  grpc::HealthCheckServiceInterface& health = *server_->GetHealthCheckService();
  const bool yes = serving == Serving::kYes;
  health.SetServingStatus(yes);
  for (const std::string& name : healthy_) health.SetServingStatus(name, yes);
}

void Listener::SetServing(const std::string& service, Serving serving) {
  server_->GetHealthCheckService()->SetServingStatus(service, serving == Serving::kYes);
}

void Listener::Shutdown(std::chrono::milliseconds grace) {
  for (const auto& acceptor : acceptors_) acceptor->Stop();
  server_->Shutdown(std::chrono::system_clock::now() + grace);
}

}  // namespace bccskel::server
