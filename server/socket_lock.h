#ifndef BCCSKEL_SERVER_SOCKET_LOCK_H_
#define BCCSKEL_SERVER_SOCKET_LOCK_H_

#include <string>

#include "absl/status/statusor.h"

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
  SocketLock(SocketLock&& other) noexcept;
  SocketLock& operator=(SocketLock&&) = delete;

 private:
  SocketLock(std::string path, int file) : path_(std::move(path)), file_(file) {}

  std::string path_;
  int file_;  // -1 once moved from
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SOCKET_LOCK_H_
