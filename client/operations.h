#ifndef BCCSKEL_CLIENT_OPERATIONS_H_
#define BCCSKEL_CLIENT_OPERATIONS_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/endpoint.h"

namespace bccskel::client {

// A server as a whole, now and since it started.
struct ServerStatus {
  std::string server_version;
  std::chrono::nanoseconds uptime{0};
  bool draining = false;  // about to stop
  uint32_t admitted_jobs = 0;
  uint32_t waiting_jobs = 0;
  uint32_t running_jobs = 0;
  uint32_t threads = 0;
  uint32_t busy_threads = 0;
  uint64_t admitted_bytes = 0;
  uint64_t max_admitted_bytes = 0;
  uint64_t resident_bytes = 0;
  uint32_t open_files = 0;
  std::chrono::nanoseconds processor_time{0};
  uint64_t calls = 0;
  uint64_t failed_calls = 0;
  uint64_t jobs = 0;
  uint64_t failed_jobs = 0;
  uint64_t object_points = 0;
  // Stored data; empty without a data directory.
  struct Stored {
    uint64_t disk_used_bytes = 0;
    uint64_t disk_available_bytes = 0;
    uint32_t unfinished_uploads = 0;
    uint32_t queued_jobs = 0;  // besides waiting_jobs
    uint32_t running_jobs = 0;
  };
  std::optional<Stored> stored;
};

// Queries of a server's operator. One attempt at each call.
// Threads: safe.
class Operations {
 public:
  // Errors: as CheckEndpoint().
  static absl::StatusOr<std::unique_ptr<Operations>> Create(const Endpoint& endpoint);
  ~Operations();

  // Whether the server, or one of its services ("bccskel.v1.JobService"), accepts calls
  // (grpc.health.v1).
  // Errors: UNAVAILABLE if it does not or cannot be reached; NOT_FOUND for an unknown service;
  //         DEADLINE_EXCEEDED.
  absl::Status CheckHealth(const std::string& service, std::chrono::milliseconds timeout,
                           const std::stop_token& stop = {});

  // Errors: the server's; PERMISSION_DENIED for a token that is not an admin's; UNIMPLEMENTED if
  //         admin calls have another address.
  absl::StatusOr<ServerStatus> GetStatus(std::chrono::milliseconds timeout,
                                         const std::stop_token& stop = {});

 private:
  class Stubs;  // keeps gRPC out of this header
  explicit Operations(std::unique_ptr<Stubs> stubs);
  std::unique_ptr<Stubs> stubs_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_OPERATIONS_H_
