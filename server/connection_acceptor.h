#ifndef BCCSKEL_SERVER_CONNECTION_ACCEPTOR_H_
#define BCCSKEL_SERVER_CONNECTION_ACCEPTOR_H_

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/descriptor.h"

namespace bccskel::server {

// Reserves the path of a Unix socket for one server. gRPC unlinks a socket that it finds there,
// which is right after a crash and wrong while another server listens. The reservation is a lock on
// the file PATH.lock beside the socket; the kernel releases it however the process ends, and a
// clean exit removes the file.
class SocketLock {
 public:
  // Does not wait.
  // Errors: ALREADY_EXISTS when another server has the path; INVALID_ARGUMENT when the file cannot
  //         be created.
  static absl::StatusOr<SocketLock> Take(const std::string& socket_path);

  ~SocketLock();
  SocketLock(SocketLock&& other) noexcept = default;
  SocketLock& operator=(SocketLock&&) = delete;

 private:
  SocketLock(std::string path, exec::Descriptor file)
      : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  exec::Descriptor file_;
};

// Listens at one address and passes on its connections. gRPC 1.51 could do that itself, but it
// stops accepting for good once it reaches the limit of open files; here connections wait until
// others close.
class ConnectionAcceptor {
 public:
  // Receives a connection accepted from `listener` and takes ownership of it. Called on the
  // acceptor's thread; must not block.
  using Take = std::function<void(int listener, int connection)>;

  // Returns once it listens, for HOST:PORT at every address of the host. For unix:PATH it replaces
  // an existing socket.
  // Errors: INVALID_ARGUMENT with the system's reason, or if PATH exists and is not a socket;
  //         ALREADY_EXISTS for a socket that somebody listens on.
  static absl::StatusOr<std::unique_ptr<ConnectionAcceptor>> Listen(const std::string& address);

  ~ConnectionAcceptor();  // as Stop()

  // With the assigned port in place of port 0.
  const std::string& address() const { return address_; }

  // Called once.
  void Start(Take take);
  // Stops listening and passing on connections. Those already passed on stay open.
  void Stop();

 private:
  ConnectionAcceptor() = default;
  absl::Status ListenToHost(const std::string& address);
  absl::Status ListenToPath(const std::string& path);
  void Serve();
  // Errors: system errors that affect more than one connection.
  absl::Status AcceptAll(int listener);

  std::string address_;
  std::string path_;  // of a Unix socket
  std::vector<exec::Descriptor> listeners_;
  exec::Descriptor stop_;  // an eventfd
  Take take_;
  std::jthread thread_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CONNECTION_ACCEPTOR_H_
