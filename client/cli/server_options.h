#ifndef BCCSKEL_CLIENT_CLI_SERVER_OPTIONS_H_
#define BCCSKEL_CLIENT_CLI_SERVER_OPTIONS_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/endpoint.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bccskel::cli {

// Which server, and what lets the user in. Paths of files, as given.
struct ServerArguments {
  std::string address = "127.0.0.1:50051";
  std::string tls_ca;
  std::string tls_certificate;
  std::string tls_key;
  std::string token_file;  // empty: as BCCSKEL_TOKEN_FILE says
  client::Endpoint::PlaintextToken plaintext_token = client::Endpoint::PlaintextToken::kRefuse;
};

// Adds --server and its companions; returns --server.
CLI::Option* AddServer(CLI::App& command, ServerArguments& server);

// Reads the files.
// Errors: NOT_FOUND for a file that cannot be read; INVALID_ARGUMENT for a token file without a
//         token.
absl::StatusOr<client::Endpoint> EndpointOf(const ServerArguments& server);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_SERVER_OPTIONS_H_
