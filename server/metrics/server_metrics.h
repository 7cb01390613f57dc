#ifndef BCCSKEL_SERVER_METRICS_SERVER_METRICS_H_
#define BCCSKEL_SERVER_METRICS_SERVER_METRICS_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "server/durable/records.h"
#include "server/jobs/compute_queue.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Resource usage of this process; 0 for what the system does not report.
struct ProcessFigures {
  std::chrono::duration<double> processor_time{0};  // user and system
  uint64_t resident_bytes = 0;
  uint64_t open_files = 0;
  uint64_t max_open_files = 0;
  uint64_t threads = 0;
};

// Cost: about 100 us, more with thousands of open files.
ProcessFigures ReadProcessFigures();

// The current state of the server.
struct ServerGauges {
  int admitted_jobs = 0;
  ComputeQueue::Usage computing;
  int threads = 0;
  uint64_t admitted_bytes = 0;
  uint64_t max_admitted_bytes = 0;
  int draining = 0;  // 1 from the stop signal on
  uint64_t dropped_log_lines = 0;
  // Expiry of the served certificate; empty without TLS.
  std::optional<std::chrono::system_clock::time_point> certificate_end;
  std::optional<DurableUsage> stored;  // empty without a data directory
};

// A call that has ended.
struct EndedCall {
  std::string method;  // "/bccskel.v1.JobService/GetJob"
  std::string code;    // "OK", "NOT_FOUND", ...
  std::string reason;  // of the ErrorInfo; empty for OK and for errors of gRPC itself
  std::chrono::duration<double> seconds{0};
};

// Totals of the counted events since the start.
struct ServerSums {
  std::atomic<uint64_t> calls = 0;
  std::atomic<uint64_t> failed_calls = 0;
  std::atomic<uint64_t> jobs = 0;
  std::atomic<uint64_t> failed_jobs = 0;
  std::atomic<uint64_t> object_points = 0;
};

// The server's metrics. Labels take few values: methods of the interface, status codes, reasons,
// configured tenants; never a job's name, a token or anything else that callers choose.
// Threads: safe. Cost: about a microsecond per event.
class ServerMetrics {
 public:
  using GaugeSource = std::function<ServerGauges()>;

  // `gauges` is called at every scrape, from any thread.
  explicit ServerMetrics(GaugeSource gauges);
  ~ServerMetrics();

  // Create the counters that alerts watch for a first event, at 0.
  void ExpectCalls(const std::string& method);
  void ExpectDurableJobs();
  void Count(const EndedCall& call);
  void CountDurable(const std::string& code, const std::string& reason);
  void Count(const JobEnd& job);
  void CountAdmitted(uint64_t volume_bytes);

  const ServerSums& sums() const { return sums_; }
  ServerGauges gauges() const { return gauges_(); }

  // Serves the metrics to Prometheus at `address`, HOST:PORT with port 0 for any free one:
  // unencrypted HTTP, /metrics.
  // Errors: INVALID_ARGUMENT for an address that cannot be used.
  absl::Status Show(const std::string& address);
  // With the assigned port; empty if not served.
  const std::string& shown_at() const { return shown_at_; }
  void Hide();

 private:
  class Families;  // keeps prometheus-cpp out of this header

  const GaugeSource gauges_;
  ServerSums sums_;
  std::unique_ptr<Families> families_;
  std::string shown_at_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_SERVER_METRICS_H_
