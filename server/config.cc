#include "server/config.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <sstream>
#include <thread>

#include "core/version/version.h"

namespace bccskel::server {
namespace {

constexpr int kUsageError = 2;

uint64_t PhysicalMemoryBytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  constexpr uint64_t kUnknown = uint64_t{4} << 30;
  return pages > 0 && page_bytes > 0
             ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(page_bytes)
             : kUnknown;
}

void AddLimits(CLI::App& app, JobPool::Limits& limits) {
  const auto positive = CLI::Range(1, 4096);
  app.add_option("--threads", limits.threads, "Threads that compute, all jobs together")
      ->check(positive)
      ->capture_default_str();
  app.add_option("--max-jobs", limits.max_jobs, "Jobs that run at the same time")
      ->check(positive)
      ->capture_default_str();
  app.add_option("--max-queue", limits.max_queue, "Jobs that may upload or wait beside them")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  app.add_option("--max-memory-bytes", limits.max_bytes,
                 "Working memory of all jobs together, such as 8GB")
      ->transform(CLI::AsSizeValue(false))
      ->capture_default_str();
  app.add_option("--max-volume-bytes", limits.max_volume_bytes,
                 "Size of one encoded volume, such as 256MB")
      ->transform(CLI::AsSizeValue(false))
      ->capture_default_str();
  app.add_option("--max-bricks", limits.volume.max_bricks,
                 "Occupied bricks (512 points each) of one volume")
      ->check(CLI::Range(uint64_t{1}, std::numeric_limits<uint64_t>::max()))
      ->capture_default_str();
}

// An error message, or nothing: gRPC would take any port modulo 65536.
std::string CheckAddress(const std::string& address) {
  if (address.rfind("unix:", 0) == 0) return address == "unix:" ? "unix: names no path" : "";
  const size_t colon = address.rfind(':');
  constexpr int kMaxPort = 65535;
  int port = -1;
  if (colon == std::string::npos || colon == 0 ||
      !CLI::detail::lexical_cast(address.substr(colon + 1), port) || port < 0 || port > kMaxPort) {
    return address + " is neither HOST:PORT, with a port of 0 to 65535, nor unix:PATH";
  }
  return "";
}

void AddOptions(CLI::App& app, ServerConfig& config) {
  constexpr int kDayMs = 86'400'000;
  const auto time = CLI::Range(0, kDayMs);
  app.set_version_flag("--version", "bccskel-server " + std::string(Version()));
  app.add_option("--listen", config.listen, "HOST:PORT (port 0: any free one) or unix:PATH")
      ->check(CheckAddress, "ADDRESS")
      ->capture_default_str();
  AddLimits(app, config.limits);
  app.add_option("--lame-duck-ms", config.lame_duck,
                 "On SIGTERM: time for a balancer's health checks to notice")
      ->check(time)
      ->capture_default_str();
  app.add_option("--drain-ms", config.drain, "On SIGTERM: time for running calls to finish")
      ->check(time)
      ->capture_default_str();
  app.add_option("--log-level", config.log_level, "What goes to standard error, as JSON lines")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
}

}  // namespace

ServerConfig DefaultServerConfig() {
  ServerConfig config;
  config.limits.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  config.limits.max_jobs = config.limits.threads;
  config.limits.max_queue = 64;
  config.limits.max_bytes = PhysicalMemoryBytes() / 4 * 3;
  config.limits.max_volume_bytes = uint64_t{1} << 30;
  return config;
}

std::variant<ServerConfig, ExitRequest> ParseServerConfig(int argc, const char* const* argv) {
  ServerConfig config = DefaultServerConfig();
  CLI::App app("Turns volumes on the body-centered cubic grid into curve skeletons, over gRPC.",
               "bccskel-server");
  AddOptions(app, config);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = app.exit(error, out, err);
    return ExitRequest{code == 0 ? 0 : kUsageError, out.str(), err.str()};
  }
  return config;
}

}  // namespace bccskel::server
