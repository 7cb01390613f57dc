#ifndef BCCSKEL_SERVER_SERVER_H_
#define BCCSKEL_SERVER_SERVER_H_

#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "server/config.h"
#include "server/jobs/job_pool.h"
#include "server/socket_lock.h"

namespace bccskel::server {

// The running server: listener, services, health, reflection and the jobs behind them.
class Server {
 public:
  // Listens when it returns.
  // Errors: INVALID_ARGUMENT for an address that cannot be listened on; ALREADY_EXISTS for a Unix
  //         socket that another server listens on.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerConfig& config);
  ~Server();

  // Where clients find it: "127.0.0.1:50051" (never with port 0) or "unix:/path".
  const std::string& address() const { return address_; }

  // Stops in good order: health says NOT_SERVING and new jobs are refused as UNAVAILABLE; after the
  // lame-duck time the jobs that were let in have the drain time to finish and to be read; then the
  // listener closes and what calls are left are cut off, which clients see as UNAVAILABLE.
  // Returns when all calls are over, at once where there are none. Needs: called once.
  void Drain();

  const JobPool& jobs() const { return jobs_; }

 private:
  class Listener;  // keeps gRPC out of this header

  explicit Server(const ServerConfig& config);
  absl::Status LockSocket();
  absl::Status Listen();

  const ServerConfig config_;
  std::optional<SocketLock> socket_lock_;  // outlives the listener
  JobPool jobs_;
  std::unique_ptr<Listener> listener_;  // after jobs_: its calls end before the jobs' threads
  std::string address_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVER_H_
