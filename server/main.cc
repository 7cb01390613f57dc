#include <pthread.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <variant>

#include "server/config.h"
#include "server/decoding/decoding_child.h"
#include "server/logging/json_log.h"
#include "server/server.h"

namespace bccskel::server {
namespace {

constexpr int kCannotListen = 1;

// Blocked in every thread, and taken by WaitForStop() alone: nothing ever runs in a signal handler.
sigset_t StopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  return signals;
}

void WaitForStop(const sigset_t& signals) {
  int received = 0;
  while (sigwait(&signals, &received) != 0) {
  }
}

int Print(const ExitRequest& exit) {
  std::fputs(exit.out.c_str(), stdout);
  std::fputs(exit.err.c_str(), stderr);
  return exit.code;
}

int Serve(const ServerConfig& config) {
  const sigset_t signals = StopSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  const Logging logging(config.log_level);
  const auto server = Server::Start(config);
  if (!server.ok()) {
    std::fprintf(stderr, "bccskel-server: %s\n", std::string(server.status().message()).c_str());
    return kCannotListen;
  }
  std::printf("listening on %s\n", (*server)->address().c_str());
  std::fflush(stdout);
  WaitForStop(signals);
  (*server)->Drain();
  return 0;
}

}  // namespace
}  // namespace bccskel::server

int main(int argc, char** argv) {
  using namespace bccskel::server;
  if (const auto code = RunIfDecodingChild(argc, argv)) return *code;
  auto parsed = ParseServerConfig(argc, argv);
  if (const auto* exit = std::get_if<ExitRequest>(&parsed)) return Print(*exit);
  auto& config = std::get<ServerConfig>(parsed);
  config.limits.decode_in_children = DecodeInChildren::kOpenExr;
  return Serve(config);
}
