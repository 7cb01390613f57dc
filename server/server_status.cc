#include "server/server_status.h"

#include <cmath>
#include <string>

#include "core/version/version.h"
#include "server/metrics/server_metrics.h"

namespace bccskel::server {
namespace {

void Set(google::protobuf::Duration& message, std::chrono::duration<double> time) {
  const double whole = std::floor(time.count());
  message.set_seconds(static_cast<int64_t>(whole));
  message.set_nanos(static_cast<int32_t>((time.count() - whole) * 1e9));
}

void Set(v1::StoredNow& message, const ServerGauges::Stored& stored) {
  message.set_disk_used_bytes(stored.disk_bytes);
  message.set_disk_available_bytes(stored.available_bytes);
  message.set_uploads_unfinished(static_cast<uint32_t>(stored.uploads));
  message.set_jobs_queued(static_cast<uint32_t>(stored.queued_jobs));
  message.set_jobs_running(static_cast<uint32_t>(stored.running_jobs));
}

void Set(v1::GetServerStatusResponse& message, const ServerGauges& now) {
  message.set_draining(now.draining != 0);
  message.mutable_jobs()->set_admitted(static_cast<uint32_t>(now.admitted_jobs));
  message.mutable_jobs()->set_waiting(static_cast<uint32_t>(now.waiting_jobs));
  message.mutable_jobs()->set_running(static_cast<uint32_t>(now.running_jobs));
  message.set_threads(static_cast<uint32_t>(now.threads));
  message.set_busy_threads(static_cast<uint32_t>(now.busy_threads));
  message.set_admitted_bytes(now.admitted_bytes);
  message.set_max_admitted_bytes(now.max_admitted_bytes);
  if (now.stored.has_value()) Set(*message.mutable_stored(), *now.stored);
}

void Set(v1::ServerTotals& message, const ServerSums& sums) {
  message.set_calls(sums.calls);
  message.set_failed_calls(sums.failed_calls);
  message.set_jobs(sums.jobs);
  message.set_failed_jobs(sums.failed_jobs);
  message.set_object_points(sums.object_points);
}

}  // namespace

v1::GetServerStatusResponse StatusOf(const ServerMetrics& metrics,
                                     std::chrono::steady_clock::time_point started) {
  v1::GetServerStatusResponse response;
  response.set_server_version(std::string(Version()));
  Set(*response.mutable_uptime(), std::chrono::steady_clock::now() - started);
  Set(response, metrics.gauges());
  const ProcessFigures process = ReadProcessFigures();
  response.set_resident_bytes(process.resident_bytes);
  response.set_open_files(static_cast<uint32_t>(process.open_files));
  Set(*response.mutable_processor_time(), process.processor_time);
  Set(*response.mutable_totals(), metrics.sums());
  return response;
}

}  // namespace bccskel::server
