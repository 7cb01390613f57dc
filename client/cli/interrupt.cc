#include "client/cli/interrupt.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace bccskel::cli {
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
