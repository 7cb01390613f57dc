#include "client/cli/console.h"

#include <cstdio>

namespace bccskel::cli {
namespace {

void PrintLine(std::string_view kind, std::string_view message) {
  std::fprintf(stderr, "bccskel: %.*s: %.*s\n", static_cast<int>(kind.size()), kind.data(),
               static_cast<int>(message.size()), message.data());
}

}  // namespace

void Warn(std::string_view message) { PrintLine("warning", message); }

ExitCode Fail(const absl::Status& error, std::string_view hint) {
  const ExitCode code = FailWith(ExitCodeOf(error), error);
  if (!hint.empty()) PrintLine("hint", hint);
  return code;
}

ExitCode FailWith(ExitCode code, const absl::Status& error) {
  PrintLine("error", std::string(error.message()));
  return code;
}

ExitCode FailOnServer(const std::string& address, const absl::Status& error,
                      std::string_view hint) {
  const std::string message(error.message());
  return Fail(absl::Status(error.code(), "server " + address + ": " + message), hint);
}

ExitCode Print(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return ExitCode::kOk;
  PrintLine("error", "cannot write to standard output");
  return ExitCode::kOutput;
}

}  // namespace bccskel::cli
