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
  // Each HOST:PORT, port 0 for any free one, or unix:PATH.
  std::vector<std::string> listen = {"127.0.0.1:50051"};
  // For reflection, admin calls and health; empty: where `listen` says, if that is this machine.
  std::string admin_listen;
  std::string metrics_listen;  // HTTP; empty: nowhere
  TlsFiles tls;                // for every HOST:PORT but the metrics'; Unix sockets have none
  std::string tokens;          // file of tokens (identity/token_table.h); empty: none are wanted
  std::string plaintext_tokens = "refuse";  // over networks without TLS; or allow
  JobPool::Limits limits;
  DurableOptions durable;
  CallerTimeouts caller_timeouts;
  std::chrono::milliseconds lame_duck{0};   // "not serving", and serving all the same
  std::chrono::milliseconds drain{25'000};  // for running calls after that
  std::string log_level = "info";           // trace, debug, info, warning, error, off
};

// Everything from what this machine has: its threads, three quarters of the memory that this
// process may use.
ServerConfig DefaultServerConfig();

using Variable = std::function<const char*(const char*)>;  // getenv()

// From the command line, the environment and a file. Bad settings are an exit request with code 2
// that names each of them; so are files that the server could not work with.
std::variant<ServerConfig, ExitRequest> ParseServerConfig(int argc, const char* const* argv,
                                                          const Variable& variable = std::getenv);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CONFIG_H_
