#include "server/metrics/server_metrics.h"

#include <prometheus/collectable.h>
#include <prometheus/counter.h>
#include <prometheus/exposer.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <sys/resource.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/pipeline/algorithm_version.h"
#include "core/version/version.h"
#include "proto/address/address.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

// A client that connects but sends no request, or does not read the response, occupies a thread for
// this time. With this many threads the next scraper rarely waits.
constexpr char kRequestTimeoutMs[] = "3000";
constexpr char kThreads[] = "16";

// civetweb accepts only numeric hosts.
std::string ForCivetweb(const std::string& address) {
  constexpr char kName[] = "localhost:";
  if (!absl::StartsWith(address, kName)) return address;
  return "127.0.0.1:" + address.substr(sizeof(kName) - 1);
}

std::chrono::duration<double> Seconds(const timeval& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
}

uint64_t CountOpenFiles() {
  std::error_code error;
  const std::filesystem::directory_iterator files("/proc/self/fd", error);
  if (error) return 0;
  return static_cast<uint64_t>(std::distance(begin(files), end(files)));
}

void ReadStatus(ProcessFigures& figures) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmRSS:", 0) == 0) figures.resident_bytes = std::stoull(line.substr(6)) * 1024;
    if (line.rfind("Threads:", 0) == 0) figures.threads = std::stoull(line.substr(8));
  }
}

using prometheus::ClientMetric;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Histogram;
using prometheus::MetricFamily;
using prometheus::MetricType;
using prometheus::Registry;

// From a fraction of a millisecond for a small volume to hours for the largest.
const Histogram::BucketBoundaries kSeconds = {0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025,
                                              0.05,   0.1,   0.25,   0.5,   1,    2.5,
                                              5,      10,    30,     60,    300,  1800};

// Series that exist before anything is counted: an alert on the increase of a counter misses one
// that first appears as 1.
struct Outcome {
  const char* code;
  const char* reason;
};
constexpr Outcome kSeenFromTheStart[] = {{"OK", ""},
                                         {"INTERNAL", "SERVER_DEFECT"},
                                         {"INTERNAL", "POISONED"},
                                         {"INTERNAL", ""},
                                         {"DATA_LOSS", "STORED_DATA_DAMAGED"}};

Family<Counter>& AddCounter(Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Histogram>& AddHistogram(Registry& registry, const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

MetricFamily Sample(MetricType type, const char* name, const char* help, auto value) {
  ClientMetric metric;
  metric.gauge.value = static_cast<double>(value);
  metric.counter.value = static_cast<double>(value);
  return {name, help, type, {std::move(metric)}};
}

MetricFamily GaugeNow(const char* name, const char* help, auto value) {
  return Sample(MetricType::Gauge, name, help, value);
}

std::vector<MetricFamily> FamiliesOf(const ServerGauges& now) {
  return {
      GaugeNow("bccskel_jobs_admitted",
               "Admitted jobs that have not ended or whose results are unread", now.admitted_jobs),
      GaugeNow("bccskel_jobs_waiting", "Jobs with a complete volume that wait for threads",
               now.computing.waiting),
      GaugeNow("bccskel_jobs_running", "Running jobs", now.computing.running),
      GaugeNow("bccskel_threads", "Compute threads", now.threads),
      GaugeNow("bccskel_threads_busy", "Busy threads", now.computing.busy_threads),
      GaugeNow("bccskel_memory_admitted_bytes", "Working memory that jobs have reserved",
               now.admitted_bytes),
      GaugeNow("bccskel_memory_limit_bytes", "Working memory that jobs may reserve together",
               now.max_admitted_bytes),
      GaugeNow("bccskel_draining", "1 from the stop signal on", now.draining),
      Sample(MetricType::Counter, "bccskel_log_lines_dropped_total",
             "Lines of the log that nobody read in time", now.dropped_log_lines),
  };
}

std::vector<MetricFamily> FamiliesOf(const DurableUsage& stored) {
  return {
      GaugeNow("bccskel_disk_used_bytes", "Volumes, results and declared uploads on disk",
               stored.disk_bytes),
      GaugeNow("bccskel_disk_available_bytes",
               "Free bytes up to the limit or the end of the file system",
               stored.disk_available_bytes),
      GaugeNow("bccskel_data_healthy", "0 when the data directory is damaged or gone",
               stored.healthy ? 1 : 0),
      GaugeNow("bccskel_uploads_unfinished", "Unfinished uploads", stored.uploads),
      GaugeNow("bccskel_durable_jobs_queued", "Waiting durable jobs", stored.queued),
      GaugeNow("bccskel_durable_jobs_running", "Running durable jobs", stored.running),
      Sample(MetricType::Counter, "bccskel_results_reused_total",
             "Durable jobs answered from a stored result", stored.cached),
  };
}

std::vector<MetricFamily> FamiliesOf(const ProcessFigures& process) {
  return {
      Sample(MetricType::Counter, "process_cpu_seconds_total", "User and system time",
             process.processor_time.count()),
      GaugeNow("process_resident_memory_bytes", "Memory in use", process.resident_bytes),
      GaugeNow("process_open_fds", "Open files and connections", process.open_files),
      GaugeNow("process_max_fds", "Limit of open files and connections", process.max_open_files),
      GaugeNow("process_threads", "Threads of the process", process.threads),
  };
}

void Append(std::vector<MetricFamily> more, std::vector<MetricFamily>& all) {
  for (MetricFamily& family : more) all.push_back(std::move(family));
}

// Metrics that are read at each scrape.
class Seen : public prometheus::Collectable {
 public:
  explicit Seen(ServerMetrics::GaugeSource gauges) : gauges_(std::move(gauges)) {}
  std::vector<MetricFamily> Collect() const override {
    const ServerGauges now = gauges_();
    std::vector<MetricFamily> all = FamiliesOf(now);
    if (now.certificate_end.has_value()) {
      all.push_back(
          GaugeNow("bccskel_certificate_not_after_seconds",
                   "When the served certificate ends, in seconds since 1970",
                   std::chrono::duration<double>(now.certificate_end->time_since_epoch()).count()));
    }
    if (now.stored.has_value()) Append(FamiliesOf(*now.stored), all);
    Append(FamiliesOf(ReadProcessFigures()), all);
    return all;
  }

 private:
  const ServerMetrics::GaugeSource gauges_;
};

}  // namespace

ProcessFigures ReadProcessFigures() {
  ProcessFigures figures;
  rusage usage = {};
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    figures.processor_time = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  }
  rlimit files = {};
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) figures.max_open_files = files.rlim_cur;
  figures.open_files = CountOpenFiles();
  ReadStatus(figures);
  return figures;
}

class ServerMetrics::Families {
 public:
  explicit Families(GaugeSource gauges) : seen(std::make_shared<Seen>(std::move(gauges))) {
    prometheus::BuildGauge()
        .Name("bccskel_build_info")
        .Help("1; what runs is in the labels")
        .Register(*registry)
        .Add({{"version", std::string(Version())}, {"algorithm", kAlgorithmVersion}})
        .Set(1);
    prometheus::BuildGauge()
        .Name("process_start_time_seconds")
        .Help("Start of the process in seconds since 1970")
        .Register(*registry)
        .Add({})
        .SetToCurrentTime();
  }

  const std::shared_ptr<Registry> registry = std::make_shared<Registry>();
  const std::shared_ptr<Seen> seen;
  Family<Counter>& calls = AddCounter(*registry, "bccskel_calls_total", "Calls that have ended");
  Family<Histogram>& call_seconds =
      AddHistogram(*registry, "bccskel_call_seconds", "From a call's first message to its status");
  Family<Counter>& jobs = AddCounter(*registry, "bccskel_jobs_total", "Jobs that have ended");
  Family<Counter>& durable_jobs =
      AddCounter(*registry, "bccskel_durable_jobs_ended_total", "Stored jobs that have ended");
  Counter& points = AddCounter(*registry, "bccskel_points_thinned_total",
                               "Points of the objects that were thinned")
                        .Add({});
  Counter& volume_bytes = AddCounter(*registry, "bccskel_volume_bytes_admitted_total",
                                     "Declared bytes of the volumes of jobs let in")
                              .Add({});
  Histogram& queued =
      AddHistogram(*registry, "bccskel_job_queue_seconds", "A job's time waiting for threads")
          .Add({}, kSeconds);
  Histogram& decoded =
      AddHistogram(*registry, "bccskel_job_decode_seconds", "A job's time in the decoder")
          .Add({}, kSeconds);
  Histogram& computed =
      AddHistogram(*registry, "bccskel_job_compute_seconds", "A job's time at computing")
          .Add({}, kSeconds);
  std::unique_ptr<prometheus::Exposer> page;  // last: it reads the others
};

ServerMetrics::ServerMetrics(GaugeSource gauges)
    : gauges_(gauges), families_(std::make_unique<Families>(std::move(gauges))) {}

ServerMetrics::~ServerMetrics() = default;

void ServerMetrics::ExpectCalls(const std::string& method) {
  for (const Outcome& outcome : kSeenFromTheStart) {
    families_->calls.Add({{"method", method}, {"code", outcome.code}, {"reason", outcome.reason}});
  }
}

void ServerMetrics::ExpectDurableJobs() {
  for (const Outcome& outcome : kSeenFromTheStart) {
    families_->durable_jobs.Add({{"code", outcome.code}, {"reason", outcome.reason}});
  }
}

void ServerMetrics::CountDurable(const std::string& code, const std::string& reason) {
  families_->durable_jobs.Add({{"code", code}, {"reason", reason}}).Increment();
}

void ServerMetrics::Count(const EndedCall& call) {
  families_->calls.Add({{"method", call.method}, {"code", call.code}, {"reason", call.reason}})
      .Increment();
  families_->call_seconds.Add({{"method", call.method}}, kSeconds).Observe(call.seconds.count());
  ++sums_.calls;
  if (call.code != "OK") ++sums_.failed_calls;
}

void ServerMetrics::Count(const JobEnd& job) {
  const absl::Status end = WithJobReason(job.status);
  families_->jobs
      .Add({{"tenant", job.tenant},
            {"code", absl::StatusCodeToString(end.code())},
            {"reason", ReasonNameOf(end)}})
      .Increment();
  ++(end.ok() ? sums_.jobs : sums_.failed_jobs);
  if (!end.ok()) return;
  const auto seconds = [](std::chrono::duration<double> time) { return time.count(); };
  families_->queued.Observe(seconds(job.times.queued));
  families_->decoded.Observe(seconds(job.times.decoded));
  families_->computed.Observe(seconds(job.times.computed));
  families_->points.Increment(static_cast<double>(job.object_points));
  sums_.object_points += job.object_points;
}

void ServerMetrics::CountAdmitted(uint64_t volume_bytes) {
  families_->volume_bytes.Increment(static_cast<double>(volume_bytes));
}

absl::Status ServerMetrics::Show(const std::string& address) {
  std::unique_ptr<prometheus::Exposer>& page = families_->page;
  try {
    page = std::make_unique<prometheus::Exposer>(
        std::vector<std::string>{"listening_ports", ForCivetweb(address), "num_threads", kThreads,
                                 "request_timeout_ms", kRequestTimeoutMs});
    page->RegisterCollectable(families_->registry);
    page->RegisterCollectable(families_->seen);
    shown_at_ = absl::StrCat(HostOf(address), ":", page->GetListeningPorts().at(0));
  } catch (const std::exception&) {
    return absl::InvalidArgumentError(absl::StrCat("cannot listen on ", address, " for metrics"));
  }
  return absl::OkStatus();
}

void ServerMetrics::Hide() { families_->page.reset(); }

}  // namespace bccskel::server
