#ifndef BCCSKEL_SERVER_CONFIG_H_
#define BCCSKEL_SERVER_CONFIG_H_

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "server/calls/sender_clock.h"
#include "server/durable/durable_options.h"
#include "server/identity/tls_files.h"
#include "server/jobs/job_pool.h"
#include "server/settings/sources.h"

namespace bccskel::server {

struct ServerConfig {
  // Each is HOST:PORT, with port 0 for any free one, or unix:PATH.
  std::vector<std::string> listen = {"127.0.0.1:50051"};
  // For reflection, admin calls and health; empty: the addresses in `listen`, if they are of this
  // machine.
  std::string admin_listen;
  std::string metrics_listen;  // HTTP; empty: no metrics
  TlsFiles tls;                // for every HOST:PORT except the metrics'; Unix sockets have no TLS
  std::string tokens;          // file of tokens (identity/token_table.h); empty: none needed
  std::string plaintext_tokens = "refuse";  // or "allow": over networks without TLS
  JobPool::Limits limits;
  DurableOptions durable;
  CallerTimeouts caller_timeouts;
  std::chrono::milliseconds lame_duck{0};   // health says "not serving", but new calls are served
  std::chrono::milliseconds drain{25'000};  // time for running calls after that
  std::string log_level = "info";           // trace, debug, info, warning, error, off
};

// Defaults for this machine: all of its threads, three quarters of the memory that this process may
// use.
ServerConfig DefaultServerConfig();

using Variable = std::function<const char*(const char*)>;  // getenv()

// Reads settings from the command line, the environment and a file. If any are bad, or name files
// that the server could not use, yields an exit request with code 2 that lists them all.
std::variant<ServerConfig, ExitRequest> ParseServerConfig(int argc, const char* const* argv,
                                                          const Variable& variable = std::getenv);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CONFIG_H_
