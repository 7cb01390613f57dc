#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>
#include <thread>
#include <variant>

#include "absl/synchronization/mutex.h"
#include "core/exec/large_blocks.h"
#include "server/config.h"
#include "server/decoding/decoding_child.h"
#include "server/logging/json_log.h"
#include "server/server.h"

namespace bccskel::server {
namespace {

constexpr int kCannotListen = 1;
constexpr int kCannotPrint = 1;

// Blocked in every thread and received only by ServeUntilStopped(): no code runs in a signal
// handler.
sigset_t Signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, number);
  return signals;
}

// Every connection is an open file; the usual limit of 1024 exists for programs that use select().
void AllowManyConnections() {
  rlimit files = {};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

// Makes writes beyond the file size limit (ulimit -f) fail instead of ending the server.
void IgnoreFileSizeSignal() { std::signal(SIGXFSZ, SIG_IGN); }

// Debian's build of Abseil looks for deadlocks at every lock.
void DisableDeadlockDetection() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
}

// By default the allocator raises its thresholds up to 64 MiB with the sizes that it sees freed,
// and makes eight arenas per processor, each of which keeps the remains of its largest job. With
// these limits, large blocks return to the system at once, others when an admitted job might need
// the memory or after half a minute. If blocks of a few MiB returned at once, too, page faults
// would make a job on a mask a tenth slower.
void LimitFreeMemory() {
  constexpr unsigned kFewestArenas = 4;
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 2 << 20);
  const unsigned arenas = std::max(kFewestArenas, std::thread::hardware_concurrency());
  mallopt(M_ARENA_MAX, static_cast<int>(arenas));
}

void ServeUntilStopped(const sigset_t& signals, Server& server) {
  constexpr timespec kBetweenChecks = {.tv_sec = 1, .tv_nsec = 0};
  constexpr int kChecksBetweenTrims = 30;
  for (int checks = 1;; ++checks) {
    if (checks % kChecksBetweenTrims == 0) {
      exec::ProcessLargeBlocks().ReleaseUnused();
      malloc_trim(0);  // frees pages between blocks in use
    }
    server.UpdateDataHealth();
    server.EnforceCallLimits();
    const int received = sigtimedwait(&signals, nullptr, &kBetweenChecks);
    if (received == SIGTERM || received == SIGINT) return;
    if (received == SIGHUP) {
      server.ReloadNow();
    } else {
      server.ReloadIfChanged();
    }
  }
}

int Print(const ExitRequest& exit) {
  const bool written = std::fputs(exit.out.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
  std::fputs(exit.err.c_str(), stderr);
  if (written) return exit.code;
  std::fputs("bccskel-server: cannot write to standard output\n", stderr);
  return kCannotPrint;
}

void Greet(const Server& server) {
  for (const std::string& address : server.addresses()) {
    std::printf("listening on %s\n", address.c_str());
  }
  const std::string admin = server.admin_address();
  if (!admin.empty()) std::printf("listening for admins on %s\n", admin.c_str());
  const std::string& metrics = server.metrics_address();
  if (!metrics.empty()) std::printf("metrics at http://%s/metrics\n", metrics.c_str());
  std::fflush(stdout);
}

int Serve(const ServerConfig& config) {
  const sigset_t signals = Signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  LimitFreeMemory();
  DisableDeadlockDetection();
  AllowManyConnections();
  IgnoreFileSizeSignal();
  const Logging logging(config.log_level);
  LogLibraryMessages();
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

int Main(int argc, char** argv) {
  if (const auto code = RunIfDecodingChild(argc, argv)) return *code;
  auto parsed = ParseServerConfig(argc, argv);
  if (const auto* exit = std::get_if<ExitRequest>(&parsed)) return Print(*exit);
  auto& config = std::get<ServerConfig>(parsed);
  config.limits.child_command = ThisProgramAsChild();
  return Serve(config);
}

}  // namespace
}  // namespace bccskel::server

int main(int argc, char** argv) {
  try {
    return bccskel::server::Main(argc, argv);
  } catch (const std::exception& error) {  // such as a lack of memory or threads at the start
    std::fprintf(stderr, "bccskel-server: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
