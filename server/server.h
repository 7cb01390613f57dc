#ifndef BCCSKEL_SERVER_SERVER_H_
#define BCCSKEL_SERVER_SERVER_H_

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/config.h"
#include "server/identity/callers.h"
#include "server/jobs/job_pool.h"
#include "server/metrics/server_metrics.h"

namespace bccskel::server {

class DurableJobs;
class JobCodec;
class Listener;
class ServedCertificates;

// The running server: listeners, services, health, reflection, metrics and the jobs behind them.
class Server {
 public:
  // Returns once it listens.
  // Errors: INVALID_ARGUMENT for an address that cannot be used, and for unusable files of tokens
  //         or certificates; ALREADY_EXISTS for a Unix socket that another server listens on.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerConfig& config);
  ~Server();

  // The addresses for clients: "127.0.0.1:50051" (never with port 0) or "unix:/path".
  const std::vector<std::string>& addresses() const;
  const std::string& address() const { return addresses().front(); }
  // The address of reflection and admin calls; empty: none, or that of the other services.
  std::string admin_address() const;
  // The HOST:PORT of the metrics for Prometheus; empty: none.
  const std::string& metrics_address() const { return metrics_.shown_at(); }

  // Reload the files of tokens and certificates, or the tokens even if their file seems unchanged,
  // and log the outcome.
  void ReloadIfChanged();
  void ReloadNow();
  // Ends calls with a removed token, and calls that have exceeded a timeout for sending or reading.
  // Needs: called once a second.
  void EnforceCallLimits();
  // Updates the health of the services that need the data directory. Needs: called once a second.
  void UpdateDataHealth();

  // Shuts down: health reports NOT_SERVING; after the lame-duck time new jobs are refused as
  // UNAVAILABLE, and admitted jobs have the drain time to finish and to be read; then the listener
  // closes and the remaining calls are aborted, which clients see as UNAVAILABLE.
  // Returns when all calls have ended, immediately if there are none. Needs: called once.
  void Drain();

  const JobPool& jobs() const { return jobs_; }

 private:
  // Keeps gRPC and messages out of this header.
  class Services;

  Server(const ServerConfig& config, std::unique_ptr<Callers> callers);
  absl::Status OpenData();
  absl::Status Listen();
  absl::Status ListenForAdmins();
  absl::Status ShowMetrics();
  ServerGauges Gauges() const;
  void WaitLameDuckTime();
  void SetTenants();
  void TakeTokens(const absl::StatusOr<Reload>& reload);

  const ServerConfig config_;
  const std::unique_ptr<Callers> callers_;
  std::atomic<bool> draining_ = false;
  bool data_healthy_ = true;  // at the last UpdateDataHealth()
  ServerMetrics metrics_;
  JobPool jobs_;
  // After jobs_: DurableJobs ends before the jobs' threads. It holds sessions of calls, which use
  // services_, so it also ends before these; the listeners end the calls first of all.
  std::unique_ptr<Services> services_;
  std::unique_ptr<const JobCodec> codec_;
  std::unique_ptr<DurableJobs> durable_jobs_;         // null without a data directory
  std::unique_ptr<ServedCertificates> certificates_;  // null without TLS
  std::unique_ptr<Listener> public_listener_;
  std::unique_ptr<Listener> admin_listener_;  // null if the public one also serves admins
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVER_H_
