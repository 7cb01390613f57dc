#include "client/channel.h"

#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <grpcpp/support/client_interceptor.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"

namespace bccskel::client {
namespace {

using grpc::experimental::ClientInterceptorFactoryInterface;
using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;

// Sends the token. gRPC's own call credentials refuse connections without TLS, including Unix
// sockets.
class TokenSender : public grpc::experimental::Interceptor {
 public:
  explicit TokenSender(const std::string& header) : header_(header) {}
  void Intercept(InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      methods->GetSendInitialMetadata()->insert({"authorization", header_});
    }
    methods->Proceed();
  }

 private:
  const std::string& header_;
};

class TokenSenders : public ClientInterceptorFactoryInterface {
 public:
  explicit TokenSenders(const std::string& token) : header_("Bearer " + token) {}
  grpc::experimental::Interceptor* CreateClientInterceptor(
      grpc::experimental::ClientRpcInfo*) override {
    return new TokenSender(header_);
  }

 private:
  const std::string header_;
};

grpc::ChannelArguments ArgumentsFor(Endpoint::Sharing sharing) {
  grpc::ChannelArguments arguments;
  // The retry loop sets the pace; gRPC's own pause after a refused connection must not exceed it.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 2000);
  // RetryLoop alone retries.
  arguments.SetInt(GRPC_ARG_ENABLE_RETRIES, 0);
  // Detects a vanished server within 50 s of a call; servers allow a ping every 10 s.
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 20'000);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, sharing == Endpoint::Sharing::kAlone);
  return arguments;
}

std::shared_ptr<grpc::ChannelCredentials> CredentialsFor(const TlsMaterial& tls) {
  if (tls.ca.empty()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions options;
  options.pem_root_certs = tls.ca;
  options.pem_cert_chain = tls.certificate;
  options.pem_private_key = tls.key;
  return grpc::SslCredentials(options);
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(const Endpoint& endpoint) {
  BCCSKEL_RETURN_IF_ERROR(CheckEndpoint(endpoint));
  std::vector<std::unique_ptr<ClientInterceptorFactoryInterface>> senders;
  BCCSKEL_ASSIGN_OR_RETURN(const std::string token, TokenToSend(endpoint.token));
  if (!token.empty()) senders.push_back(std::make_unique<TokenSenders>(token));
  return grpc::experimental::CreateCustomChannelWithInterceptors(
      endpoint.address, CredentialsFor(endpoint.tls), ArgumentsFor(endpoint.sharing),
      std::move(senders));
}

void AwaitReconnection(grpc::Channel& channel, std::chrono::system_clock::time_point deadline) {
  const grpc_connectivity_state state = channel.GetState(false);
  if (state != GRPC_CHANNEL_TRANSIENT_FAILURE && state != GRPC_CHANNEL_CONNECTING) return;
  channel.WaitForConnected(
      std::min(deadline, std::chrono::system_clock::now() + std::chrono::milliseconds(300)));
}

}  // namespace bccskel::client
