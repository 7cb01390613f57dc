#include "client/cli/console.h"

#include <cstdio>
#include <string>

#include "proto/wire/error_details.h"

namespace bccskel::cli {
namespace {

void PrintLine(std::string_view kind, std::string_view message) {
  std::fprintf(stderr, "bccskel: %.*s: %.*s\n", static_cast<int>(kind.size()), kind.data(),
               static_cast<int>(message.size()), message.data());
}

// Who speaks plainly to a server with TLS learns from it only that the connection broke.
bool MayWantTls(const ServerArguments& server, const absl::Status& error) {
  return absl::IsUnavailable(error) && !wire::ErrorInfoOf(error).has_value() &&
         server.tls_ca.empty() && server.address.compare(0, 5, "unix:") != 0;
}

// Files that may not be read are no question of credentials.
ExitCode CodeOf(const absl::Status& error) {
  return absl::IsPermissionDenied(error) ? ExitCode::kCredentials : ExitCodeOf(error);
}

}  // namespace

void Warn(std::string_view message) { PrintLine("warning", message); }

void Note(std::string_view message) { PrintLine("note", message); }

ExitCode Fail(const absl::Status& error, std::string_view hint) {
  const ExitCode code = FailWith(ExitCodeOf(error), error);
  if (!hint.empty()) PrintLine("hint", hint);
  return code;
}

ExitCode FailWith(ExitCode code, const absl::Status& error) {
  PrintLine("error", std::string(error.message()));
  return code;
}

ExitCode FailOnServer(const ServerArguments& server, const absl::Status& error,
                      std::string_view hint) {
  const std::string message = "server " + server.address + ": " + std::string(error.message());
  const ExitCode code = FailWith(CodeOf(error), absl::Status(error.code(), message));
  if (!hint.empty()) PrintLine("hint", hint);
  if (MayWantTls(server, error)) {
    PrintLine("hint", "should the server speak TLS, say with --tls-ca who signs its certificate");
  }
  return code;
}

ExitCode Print(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return ExitCode::kOk;
  PrintLine("error", "cannot write to standard output");
  return ExitCode::kOutput;
}

}  // namespace bccskel::cli
