#include "tests/server/support/running_server.h"

#include <chrono>
#include <stdexcept>
#include <thread>

namespace bccskel::test {

using server::Server;

server::ServerConfig SmallServer() {
  server::ServerConfig config = server::DefaultServerConfig();
  config.listen = {"127.0.0.1:0"};
  config.limits.threads = config.limits.max_jobs = 2;
  config.limits.max_bytes = uint64_t{2} << 30;
  return config;
}

std::unique_ptr<Server> StartServer(const server::ServerConfig& config) {
  absl::StatusOr<std::unique_ptr<Server>> server = Server::Start(config);
  if (!server.ok()) throw std::runtime_error(server.status().ToString());
  return *std::move(server);
}

std::shared_ptr<grpc::Channel> ConnectTo(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

void WaitUntilIdle(const Server& server) {
  while (server.jobs().admission_usage() != server::Admission::Usage() ||
         server.jobs().compute_usage() != server::ComputeQueue::Usage()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace bccskel::test
