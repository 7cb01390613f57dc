#include "server/listener.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "server/service/server_service.h"

namespace bccskel::server {
namespace {

constexpr char kUnixPrefix[] = "unix:";
// Clients may ping every 10 s, also between calls; more often than that is abuse.
constexpr int kMinPingIntervalMs = 10'000;
// A client that vanished without a word is found out by these.
constexpr int kPingIntervalMs = 60'000, kPingTimeoutMs = 20'000;
// For a connection to begin to speak HTTP/2.
constexpr int kHandshakeMs = 20'000;
constexpr unsigned kCertificateCheckSeconds = 1;

// gRPC adds reflection, its only plug-in here, to all servers of the process.
class WithoutReflection : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    plugins->clear();
  }
};

void Configure(grpc::ServerBuilder& builder) {
  builder.SetMaxReceiveMessageSize(kMaxMessageBytes);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);  // a second server must fail, not share
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             kMinPingIntervalMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kPingIntervalMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kPingTimeoutMs);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMs);
}

// Nothing where it is no Unix socket.
std::optional<std::string> SocketPathOf(const std::string& address) {
  if (address.rfind(kUnixPrefix, 0) != 0) return std::nullopt;
  const std::string path = address.substr(std::strlen(kUnixPrefix));
  return path.rfind("//", 0) == 0 ? path.substr(2) : path;  // unix:/path or unix:///path
}

std::string AddressOf(const std::string& listen, int port) {
  if (SocketPathOf(listen).has_value()) return listen;
  return absl::StrCat(listen.substr(0, listen.rfind(':')), ":", port);
}

std::shared_ptr<grpc::ServerCredentials> TlsCredentials(const TlsFiles& files) {
  using grpc::experimental::FileWatcherCertificateProvider;
  grpc::experimental::TlsServerCredentialsOptions options(
      std::make_shared<FileWatcherCertificateProvider>(files.key, files.certificate,
                                                       files.client_ca, kCertificateCheckSeconds));
  options.watch_identity_key_cert_pairs();
  if (!files.client_ca.empty()) {
    options.watch_root_certs();
    options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return grpc::experimental::TlsServerCredentials(options);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Listener>> Listener::Start(ListenerPlan plan) {
  static std::once_flag once;
  std::call_once(once, [] {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  });
  std::unique_ptr<Listener> listener(new Listener);
  BCCSKEL_RETURN_IF_ERROR(CheckTlsFiles(plan.tls));
  BCCSKEL_RETURN_IF_ERROR(listener->LockSockets(plan.addresses));
  BCCSKEL_RETURN_IF_ERROR(listener->Listen(plan));
  listener->healthy_ = std::move(plan.healthy);
  listener->SetServing(Serving::kYes);
  return listener;
}

absl::Status Listener::LockSockets(const std::vector<std::string>& addresses) {
  for (const std::string& address : addresses) {
    const std::optional<std::string> path = SocketPathOf(address);
    if (!path.has_value()) continue;
    BCCSKEL_ASSIGN_OR_RETURN(SocketLock lock, SocketLock::Take(*path));
    locks_.push_back(std::move(lock));
  }
  return absl::OkStatus();
}

absl::Status Listener::Listen(ListenerPlan& plan) {
  grpc::ServerBuilder builder;
  const auto plain = grpc::InsecureServerCredentials();
  const auto tls = plan.tls.enabled() ? TlsCredentials(plan.tls) : plain;
  std::deque<int> ports;  // written while the server is built
  for (const std::string& address : plan.addresses) {
    const auto& credentials = SocketPathOf(address).has_value() ? plain : tls;
    builder.AddListeningPort(address, credentials, &ports.emplace_back(0));
  }
  for (grpc::Service* service : plan.services) builder.RegisterService(service);
  if (plan.reflection == ListenerPlan::Reflection::kOff) {
    builder.SetOption(std::make_unique<WithoutReflection>());
  }
  Configure(builder);
  builder.experimental().SetInterceptorCreators(std::move(plan.interceptors));
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot listen on ", absl::StrJoin(plan.addresses, " or ")));
  }
  for (size_t n = 0; n < ports.size(); ++n) {
    addresses_.push_back(AddressOf(plan.addresses[n], ports[n]));
  }
  return absl::OkStatus();
}

void Listener::SetServing(Serving serving) {
  grpc::HealthCheckServiceInterface& health = *server_->GetHealthCheckService();
  const bool yes = serving == Serving::kYes;
  health.SetServingStatus(yes);
  for (const std::string& name : healthy_) health.SetServingStatus(name, yes);
}

void Listener::Shutdown(std::chrono::milliseconds grace) {
  server_->Shutdown(std::chrono::system_clock::now() + grace);
}

}  // namespace bccskel::server
