#include "server/connection_acceptor.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/address/address.h"
#include "server/logging/json_log.h"

namespace bccskel::server {
namespace {

constexpr int kOwnerOnly = 0600;

// Whether the path still names the locked file: the previous holder may have removed it between our
// open and our lock.
bool IsNamedBy(int file, const std::string& path) {
  struct stat opened = {}, named = {};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

constexpr int kPauseMs = 100;

absl::Status CannotListen(const std::string& address, const std::string& why) {
  return absl::InvalidArgumentError(absl::StrCat("cannot listen on ", address, ": ", why));
}

// Errors: INVALID_ARGUMENT with the system's reason.
absl::StatusOr<exec::Descriptor> ListenTo(const sockaddr* name, socklen_t size,
                                          const std::string& address) {
  constexpr int kOn = 1;
  exec::Descriptor listener(socket(name->sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  // Lets a restarted server bind while connections of the previous one linger for a minute.
  if (name->sa_family != AF_UNIX) {
    setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &kOn, sizeof(kOn));
  }
  if (!listener.is_open() || bind(listener.get(), name, size) != 0 ||
      listen(listener.get(), SOMAXCONN) != 0) {
    return CannotListen(address, std::strerror(errno));
  }
  return listener;
}

absl::Status OtherListens(const std::string& path) {
  return absl::AlreadyExistsError(absl::StrCat("another server listens on unix:", path));
}

// Removes the socket that a crash has left. Any other file of this name is not ours to remove.
absl::Status RemoveSocket(const sockaddr_un& name, const std::string& path) {
  struct stat there = {};
  if (lstat(path.c_str(), &there) != 0) return absl::OkStatus();
  if (!S_ISSOCK(there.st_mode)) {
    return CannotListen("unix:" + path, "the path exists and is not a socket");
  }
  // Somebody may have removed its lock.
  const exec::Descriptor caller(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int called = connect(caller.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name));
  if (called == 0 || errno == EAGAIN) return OtherListens(path);
  unlink(path.c_str());
  return absl::OkStatus();
}

int PortOf(const exec::Descriptor& listener) {
  sockaddr_storage name = {};
  socklen_t size = sizeof(name);
  if (getsockname(listener.get(), reinterpret_cast<sockaddr*>(&name), &size) != 0) return 0;
  return ntohs(name.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6*>(&name)->sin6_port
                                          : reinterpret_cast<sockaddr_in*>(&name)->sin_port);
}

void SetPort(sockaddr& name, int port) {
  const auto number = htons(static_cast<uint16_t>(port));
  if (name.sa_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6&>(name).sin6_port = number;
  } else {
    reinterpret_cast<sockaddr_in&>(name).sin_port = number;
  }
}

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

absl::StatusOr<Addresses> Resolve(const std::string& address) {
  std::string host = HostOf(address);
  const std::string port = address.substr(host.size() + 1);
  if (host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  addrinfo hints = {};
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  if (error != 0) return CannotListen(address, gai_strerror(error));
  return Addresses(found, freeaddrinfo);
}

}  // namespace

absl::StatusOr<SocketLock> SocketLock::Take(const std::string& socket_path) {
  const std::string path = socket_path + ".lock";
  while (true) {
    exec::Descriptor file(open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, kOwnerOnly));
    if (!file.is_open()) {
      return absl::InvalidArgumentError(
          absl::StrCat("cannot make ", path, ": ", std::strerror(errno)));
    }
    if (flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
      return OtherListens(socket_path);
    }
    if (IsNamedBy(file.get(), path)) return SocketLock(path, std::move(file));
  }
}

SocketLock::~SocketLock() {
  // Before releasing the lock: afterwards the file may belong to another server.
  if (file_.is_open()) unlink(path_.c_str());
}

absl::StatusOr<std::unique_ptr<ConnectionAcceptor>> ConnectionAcceptor::Listen(
    const std::string& address) {
  std::unique_ptr<ConnectionAcceptor> acceptor(new ConnectionAcceptor);
  acceptor->stop_ = exec::Descriptor(eventfd(0, EFD_CLOEXEC));
  const std::string path = SocketPathOf(address);
  BCCSKEL_RETURN_IF_ERROR(path.empty() ? acceptor->ListenToHost(address)
                                       : acceptor->ListenToPath(path));
  if (!path.empty()) acceptor->address_ = address;
  return acceptor;
}

ConnectionAcceptor::~ConnectionAcceptor() { Stop(); }

// A host may have addresses of a kind that this machine lacks; one that works is enough.
absl::Status ConnectionAcceptor::ListenToHost(const std::string& address) {
  BCCSKEL_ASSIGN_OR_RETURN(const Addresses found, Resolve(address));
  absl::Status failure = CannotListen(address, "it has no address");
  int port = 0;
  for (addrinfo* entry = found.get(); entry != nullptr; entry = entry->ai_next) {
    if (port != 0) SetPort(*entry->ai_addr, port);
    auto listener = ListenTo(entry->ai_addr, entry->ai_addrlen, address);
    if (!listener.ok()) {
      failure = listener.status();
      continue;
    }
    port = PortOf(*listener);
    listeners_.push_back(*std::move(listener));
  }
  address_ = absl::StrCat(HostOf(address), ":", port);
  return listeners_.empty() ? failure : absl::OkStatus();
}

absl::Status ConnectionAcceptor::ListenToPath(const std::string& path) {
  sockaddr_un name = {};
  name.sun_family = AF_UNIX;
  if (path.size() >= sizeof(name.sun_path)) {
    return CannotListen(path, absl::StrCat("the path has ", path.size(), " bytes, the limit is ",
                                           sizeof(name.sun_path) - 1));
  }
  path.copy(name.sun_path, path.size());
  BCCSKEL_RETURN_IF_ERROR(RemoveSocket(name, path));
  BCCSKEL_ASSIGN_OR_RETURN(
      exec::Descriptor listener,
      ListenTo(reinterpret_cast<const sockaddr*>(&name), sizeof(name), "unix:" + path));
  listeners_.push_back(std::move(listener));
  path_ = path;
  return absl::OkStatus();
}

void ConnectionAcceptor::Start(Take take) {
  take_ = std::move(take);
  thread_ = std::jthread([this] { Serve(); });
}

void ConnectionAcceptor::Stop() {
  if (thread_.joinable()) {
    eventfd_write(stop_.get(), 1);
    thread_.join();
  }
  listeners_.clear();
  if (!path_.empty()) unlink(std::exchange(path_, std::string()).c_str());
}

void ConnectionAcceptor::Serve() {
  std::vector<pollfd> events = {{stop_.get(), POLLIN, 0}};
  for (const exec::Descriptor& listener : listeners_) events.push_back({listener.get(), POLLIN, 0});
  absl::Status seen;
  while (true) {
    absl::Status now;
    for (size_t n = 1; n < events.size() && now.ok(); ++n) now = AcceptAll(events[n].fd);
    if (now != seen) {
      Log(now.ok() ? LogLevel::kInfo : LogLevel::kError,
          now.ok() ? "connections are accepted again" : "connections wait",
          {{"address", address_}, {"message", std::string(now.message())}});
    }
    seen = now;
    // While no file descriptor is free, wait only for the stop.
    const bool full = !now.ok();
    poll(events.data(), full ? 1 : events.size(), full ? kPauseMs : -1);
    if ((events[0].revents & POLLIN) != 0) return;
  }
}

absl::Status ConnectionAcceptor::AcceptAll(int listener) {
  constexpr int kOn = 1;
  while (true) {
    const int connection = accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (connection >= 0) {
      setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof(kOn));  // fails for unix:
      take_(listener, connection);
      continue;
    }
    if (errno == EAGAIN) return absl::OkStatus();
    const bool of_machine =
        errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
    if (of_machine) return absl::ResourceExhaustedError(std::strerror(errno));
  }
}

}  // namespace bccskel::server
