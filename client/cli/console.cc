#include "client/cli/console.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <variant>

#include "client/cli/arguments.h"
#include "client/cli/progress_bar.h"
#include "client/endpoint.h"
#include "proto/wire/error_details.h"

namespace bccskel::cli {

ExitCode ExitCodeOf(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return ExitCode::kOk;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kNotFound:
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kUnimplemented:
    case absl::StatusCode::kOutOfRange:
      return ExitCode::kBadInput;
    case absl::StatusCode::kUnauthenticated:
      return ExitCode::kCredentials;
    case absl::StatusCode::kUnavailable:
      return ExitCode::kUnavailable;
    case absl::StatusCode::kCancelled:
    case absl::StatusCode::kDeadlineExceeded:
      return ExitCode::kStopped;
    case absl::StatusCode::kResourceExhausted:
      return ExitCode::kTooLarge;
    default:
      return ExitCode::kInternal;
  }
}

namespace {

std::string_view program_name = "bccskel";

void PrintLine(std::string_view kind, std::string_view message) {
  EndProgressLine();
  std::fprintf(stderr, "%.*s: %.*s: %.*s\n", static_cast<int>(program_name.size()),
               program_name.data(), static_cast<int>(kind.size()), kind.data(),
               static_cast<int>(message.size()), message.data());
}

client::ConnectionFault FaultOf(const ServerArguments& server, const absl::Status& error) {
  if (wire::ErrorInfoOf(error).has_value()) return client::ConnectionFault::kNoServer;
  return client::ConnectionFaultOf(
      {error.message().data(), error.message().size()}, server.address,
      server.tls_ca.empty() ? client::Encryption::kNone : client::Encryption::kTls);
}

std::string ReachHint(client::ConnectionFault fault, std::string_view local) {
  switch (fault) {
    case client::ConnectionFault::kServerHasNoTls:
      return "the server has no TLS: start it with --tls-cert and --tls-key, or omit --tls-ca "
             "if the network is trusted";
    case client::ConnectionFault::kNotTrusted:
      return "name the authority that signed the server's certificate with --tls-ca";
    case client::ConnectionFault::kMayWantTls:
      return "if the server uses TLS, name its certificate authority with --tls-ca";
    case client::ConnectionFault::kNoServer:
      break;
  }
  return local.empty()
             ? "start bccskel-server, or name another server with --server"
             : "start bccskel-server, name another server with --server, or compute here with " +
                   std::string(local);
}

bool GivesToken(const ServerArguments& server) {
  return !server.token_file.empty() || std::getenv("BCCSKEL_TOKEN_FILE") != nullptr;
}

// The error's message without a mention of jobs, which do not exist on this machine.
std::string MessageHere(const absl::Status& error) {
  constexpr std::string_view kOfJob = "the job was cancelled";
  std::string message(error.message());
  if (absl::IsCancelled(error) && message.ends_with(kOfJob)) {
    message.replace(message.size() - kOfJob.size(), message.npos, "interrupted");
  }
  return message;
}

// kCredentials only for servers: an unreadable file is not a question of credentials.
ExitCode CodeOf(const absl::Status& error) {
  return absl::IsPermissionDenied(error) ? ExitCode::kCredentials : ExitCodeOf(error);
}

}  // namespace

void SetProgramName(std::string_view name) { program_name = name; }

std::string_view ProgramName() { return program_name; }

void Warn(std::string_view message) { PrintLine("warning", message); }

ExitCode Fail(const absl::Status& error, std::string_view hint) {
  const ExitCode code = FailWith(ExitCodeOf(error), error);
  if (!hint.empty()) PrintLine("hint", hint);
  return code;
}

ExitCode FailWith(ExitCode code, const absl::Status& error) {
  PrintLine("error", MessageHere(error));
  return code;
}

ExitCode FailOnServer(const ServerArguments& server, const absl::Status& error,
                      std::string_view local) {
  PrintLine("error", "server " + server.address + ": " + std::string(error.message()));
  if (absl::IsUnauthenticated(error)) {
    PrintLine("hint", GivesToken(server) ? "check the token's file, or ask the server's operator"
                                         : "name the file of your token with --token-file");
  }
  if (absl::IsUnavailable(error)) PrintLine("hint", ReachHint(FaultOf(server, error), local));
  return CodeOf(error);
}

ExitCode Print(std::string_view text) {
  EndProgressLine();
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return ExitCode::kOk;
  PrintLine("error", "cannot write to standard output");
  return ExitCode::kOutput;
}

namespace {

ExitCode ExitCodeOfSignal(int signal) {
  return signal == SIGTERM ? ExitCode::kTerminated : ExitCode::kInterrupted;
}

}  // namespace

Interrupt::Interrupt() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signals_ = ::signalfd(-1, &signals, SFD_CLOEXEC);
  leave_ = ::eventfd(0, EFD_CLOEXEC);
  thread_ = std::thread([this] { Watch(); });
}

Interrupt::~Interrupt() {
  ::eventfd_write(leave_, 1);
  thread_.join();
  ::close(signals_);
  ::close(leave_);
}

std::optional<ExitCode> Interrupt::exit_code() const {
  const int signal = signal_.load();
  if (signal == 0) return std::nullopt;
  return ExitCodeOfSignal(signal);
}

void Interrupt::Watch() {
  std::array<pollfd, 2> events = {{{signals_, POLLIN, 0}, {leave_, POLLIN, 0}}};
  while (::poll(events.data(), events.size(), -1) >= 0 && events[1].revents == 0) {
    signalfd_siginfo info;
    if (::read(signals_, &info, sizeof info) != sizeof info) return;
    const int signal = static_cast<int>(info.ssi_signo);
    if (signal_.exchange(signal) != 0) ::_exit(static_cast<int>(ExitCodeOfSignal(signal)));
    source_.request_stop();
  }
}

}  // namespace bccskel::cli
