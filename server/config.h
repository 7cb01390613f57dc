#ifndef BCCSKEL_SERVER_CONFIG_H_
#define BCCSKEL_SERVER_CONFIG_H_

#include <chrono>
#include <cstdint>
#include <string>
#include <variant>

#include "server/jobs/job_pool.h"

namespace bccskel::server {

struct ServerConfig {
  std::string listen = "127.0.0.1:50051";  // HOST:PORT, port 0 for any free one, or unix:PATH
  JobPool::Limits limits;
  std::chrono::milliseconds lame_duck{0};   // at least so long "not serving" before the end
  std::chrono::milliseconds drain{25'000};  // for running calls after that
  std::string log_level = "info";           // trace, debug, info, warning, error, off
};

// Everything from what this machine has: its threads, three quarters of its memory.
ServerConfig DefaultServerConfig();

// The process has nothing to serve: what it printed and its exit code.
struct ExitRequest {
  int code = 0;
  std::string out;  // for standard output
  std::string err;  // for standard error
};

// Errors are exit requests with code 2.
std::variant<ServerConfig, ExitRequest> ParseServerConfig(int argc, const char* const* argv);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CONFIG_H_
