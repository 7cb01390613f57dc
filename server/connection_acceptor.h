#ifndef BCCSKEL_SERVER_CONNECTION_ACCEPTOR_H_
#define BCCSKEL_SERVER_CONNECTION_ACCEPTOR_H_

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {

// One server's right to the path of a Unix socket. gRPC unlinks a socket that it finds there, which
// is right after a crash and wrong while another server listens. The right is a lock on the file
// PATH.lock beside the socket; the kernel gives it back however the process ends, and a clean end
// removes the file.
class SocketLock {
 public:
  // Errors: ALREADY_EXISTS when another server has it; INVALID_ARGUMENT when the file cannot be
  //         made. Nothing waits.
  static absl::StatusOr<SocketLock> Take(const std::string& socket_path);

  ~SocketLock();
  SocketLock(SocketLock&& other) noexcept = default;
  SocketLock& operator=(SocketLock&&) = delete;

 private:
  SocketLock(std::string path, Descriptor file) : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  Descriptor file_;
};

// Listens at one address and hands on what comes in. gRPC 1.51 could do that itself, but stops for
// good when it meets the limit of open files once; here connections wait until there is room.
class ConnectionAcceptor {
 public:
  // Receives a connection accepted from `listener`, and owns it from then on. Called on a thread of
  // the acceptor; must not block.
  using Take = std::function<void(int listener, int connection)>;

  // Listens when it returns: HOST:PORT, at every address of the host, or unix:PATH, where it
  // replaces an existing socket.
  // Errors: INVALID_ARGUMENT with the system's reason, or if PATH exists and is not a socket.
  static absl::StatusOr<std::unique_ptr<ConnectionAcceptor>> Listen(const std::string& address);

  ~ConnectionAcceptor();  // as Stop()

  // With the port that port 0 became.
  const std::string& address() const { return address_; }

  // Called once.
  void Start(Take take);
  // Nobody listens any more, and nothing is handed on. What was is not touched.
  void Stop();

 private:
  ConnectionAcceptor() = default;
  absl::Status ListenToHost(const std::string& address);
  absl::Status ListenToPath(const std::string& path);
  void Serve();
  // Errors: those of the system that concern more than one connection.
  absl::Status AcceptAll(int listener);

  std::string address_;
  std::string path_;  // of a Unix socket
  std::vector<Descriptor> listeners_;
  Descriptor stop_;  // an eventfd
  Take take_;
  std::jthread thread_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CONNECTION_ACCEPTOR_H_
