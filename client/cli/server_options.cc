#include "client/cli/server_options.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "absl/strings/ascii.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

constexpr char kTokenVariable[] = "BCCSKEL_TOKEN_FILE";

// Empty where no file is named.
absl::StatusOr<std::string> ReadText(const std::string& path) {
  if (path.empty()) return std::string();
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) return absl::NotFoundError(path + ": cannot be read");
  return text;
}

std::string TokenPath(const ServerArguments& server) {
  const char* const variable = std::getenv(kTokenVariable);
  return server.token_file.empty() && variable != nullptr ? variable : server.token_file;
}

// The first line of the file. Never part of a message.
absl::StatusOr<std::string> ReadToken(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(std::string token, ReadText(path));
  token.resize(std::min(token.find('\n'), token.size()));
  absl::StripAsciiWhitespace(&token);
  for (const char c : token) {
    if (!absl::ascii_isgraph(static_cast<unsigned char>(c))) token.clear();
  }
  if (token.empty() && !path.empty()) {
    return absl::InvalidArgumentError(path + ": its first line is no token");
  }
  return token;
}

}  // namespace

CLI::Option* AddServer(CLI::App& command, ServerArguments& server) {
  command
      .add_option("--tls-ca", server.tls_ca,
                  "Use TLS; who may sign the server's certificate, PEM (of this machine: "
                  "/etc/ssl/certs/ca-certificates.crt)")
      ->option_text("FILE");
  command.add_option("--tls-cert", server.tls_certificate, "Certificate to show the server, PEM")
      ->option_text("FILE");
  command.add_option("--tls-key", server.tls_key, "Its key, PEM")->option_text("FILE");
  command
      .add_option("--token-file", server.token_file,
                  "Holds the token that the server wants; BCCSKEL_TOKEN_FILE names one, too")
      ->option_text("FILE");
  command.add_flag_callback(
      "--plaintext-token",
      [&server] { server.plaintext_token = client::Endpoint::PlaintextToken::kAllow; },
      "Send the token over a network without TLS, too");
  return command
      .add_option("--server", server.address,
                  "Where the server is (default " + server.address + ")")
      ->option_text("HOST:PORT|unix:PATH");
}

absl::StatusOr<client::Endpoint> EndpointOf(const ServerArguments& server) {
  client::Endpoint endpoint;
  endpoint.address = server.address;
  endpoint.plaintext_token = server.plaintext_token;
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.tls.ca, ReadText(server.tls_ca));
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.tls.certificate, ReadText(server.tls_certificate));
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.tls.key, ReadText(server.tls_key));
  BCCSKEL_ASSIGN_OR_RETURN(endpoint.token, ReadToken(TokenPath(server)));
  return endpoint;
}

}  // namespace bccskel::cli
