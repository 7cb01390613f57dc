#ifndef BCCSKEL_SERVER_LISTENER_H_
#define BCCSKEL_SERVER_LISTENER_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/connection_acceptor.h"
#include "server/metrics/server_metrics.h"
#include "server/served_certificates.h"

namespace bccskel::server {

// What a set of addresses serves.
struct ListenerPlan {
  std::vector<std::string> addresses;    // each HOST:PORT or unix:PATH
  ServedCertificates* tls = nullptr;     // for each HOST:PORT; null: no encryption
  std::vector<grpc::Service*> services;  // not owned
  std::vector<std::string> healthy;      // full names of the services in health checks
  enum class Reflection { kOff, kOn } reflection = Reflection::kOff;
  ServerMetrics* metrics = nullptr;  // counts the calls; null: no counts
};

// Listens on addresses and serves the calls that arrive there. Also answers health checks, which
// need no token.
class Listener {
 public:
  // Returns once it listens.
  // Errors: INVALID_ARGUMENT for an address that cannot be used; ALREADY_EXISTS for a Unix socket
  //         that another server listens on.
  static absl::StatusOr<std::unique_ptr<Listener>> Start(ListenerPlan plan);

  // In the order of the plan, with assigned ports in place of port 0.
  const std::vector<std::string>& addresses() const { return addresses_; }

  enum class Serving { kYes, kNo };
  void SetServing(Serving serving);
  void SetServing(const std::string& service, Serving serving);

  // Refuses new calls immediately; aborts running ones that have not ended within `grace`.
  void Shutdown(std::chrono::milliseconds grace);

 private:
  Listener() = default;
  absl::Status Listen(const std::vector<std::string>& addresses);
  absl::Status Serve(ListenerPlan& plan);

  std::vector<SocketLock> locks_;  // outlive the sockets
  std::vector<std::string> addresses_;
  std::vector<std::string> healthy_;
  std::unique_ptr<grpc::Server> server_;
  std::vector<std::unique_ptr<ConnectionAcceptor>> acceptors_;  // stop before the server
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_LISTENER_H_
