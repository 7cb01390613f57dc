#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <ctime>
#include <string>
#include <variant>

#include "server/config.h"
#include "server/decoding/decoding_child.h"
#include "server/logging/grpc_log.h"
#include "server/logging/json_log.h"
#include "server/server.h"

namespace bccskel::server {
namespace {

constexpr int kCannotListen = 1;

// Blocked in every thread, and taken by ServeUntilStopped() alone: nothing ever runs in a signal
// handler.
sigset_t Signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, number);
  return signals;
}

// Every connection is an open file; the usual limit of 1024 is for programs that use select().
void AllowManyConnections() {
  rlimit files = {};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

// A file at the limit of its size (ulimit -f) is an error of writing, not the end of the server.
void OutliveFullFiles() { std::signal(SIGXFSZ, SIG_IGN); }

void ServeUntilStopped(const sigset_t& signals, Server& server) {
  constexpr timespec kBetweenLooks = {.tv_sec = 1, .tv_nsec = 0};
  constexpr int kLooksBetweenTrims = 30;
  for (int looks = 1;; ++looks) {
    // Every thread's arena keeps what its largest job has left: 94 of 125 MiB.
    if (looks % kLooksBetweenTrims == 0) malloc_trim(0);
    const int received = sigtimedwait(&signals, nullptr, &kBetweenLooks);
    if (received == SIGTERM || received == SIGINT) return;
    if (received == SIGHUP) {
      server.ReloadNow();
    } else {
      server.ReloadIfChanged();
    }
  }
}

int Print(const ExitRequest& exit) {
  std::fputs(exit.out.c_str(), stdout);
  std::fputs(exit.err.c_str(), stderr);
  return exit.code;
}

void Greet(const Server& server) {
  for (const std::string& address : server.addresses()) {
    std::printf("listening on %s\n", address.c_str());
  }
  const std::string admin = server.admin_address();
  if (!admin.empty()) std::printf("listening for admins on %s\n", admin.c_str());
  const std::string metrics = server.metrics_address();
  if (!metrics.empty()) std::printf("metrics at http://%s/metrics\n", metrics.c_str());
  std::fflush(stdout);
}

int Serve(const ServerConfig& config) {
  const sigset_t signals = Signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  AllowManyConnections();
  OutliveFullFiles();
  const Logging logging(config.log_level);
  LogWhatGrpcSays();
  const auto server = Server::Start(config);
  if (!server.ok()) {
    std::fprintf(stderr, "bccskel-server: %s\n", std::string(server.status().message()).c_str());
    return kCannotListen;
  }
  Greet(**server);
  ServeUntilStopped(signals, **server);
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
