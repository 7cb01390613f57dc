#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/summaries.h"
#include "client/operations.h"
#include "client/retry_policy.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

using client::ServerStatus;

// A server's activity per second between two queries.
struct TopRates {
  double calls = 0;
  double jobs = 0;
  double points = 0;
  double processors = 0;  // processor seconds per second
};

double InSeconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

double Mebibytes(uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

// A restarted server counts from zero.
double Rate(uint64_t before, uint64_t after, double seconds) {
  return after < before || seconds <= 0 ? 0 : static_cast<double>(after - before) / seconds;
}

// The full width stands for `whole`.
std::string Bar(double part, double whole) {
  constexpr int kWidth = 30;
  const double share = whole > 0 ? std::min(part / whole, 1.0) : 0;
  const auto filled = static_cast<size_t>(share * kWidth + 0.5);
  return absl::StrCat("[", std::string(filled, '#'), std::string(kWidth - filled, '.'), "]");
}

std::string UptimeText(std::chrono::nanoseconds uptime) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(uptime).count();
  return absl::StrFormat("%d:%02d:%02d", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

std::string RatesText(const TopRates& rates) {
  return absl::StrFormat(
      "per second  %.1f calls   %.1f jobs   %.2f million points   %.2f processors\n", rates.calls,
      rates.jobs, rates.points / 1e6, rates.processors);
}

std::string StoredText(const ServerStatus::Stored& stored) {
  const double used = Mebibytes(stored.disk_used_bytes);
  const double available = Mebibytes(stored.disk_available_bytes);
  return absl::StrFormat(
      "durable     %d jobs queued, %d running, %d unfinished uploads\n"
      "disk        %s %.0f MiB used, %.0f MiB left\n",
      stored.queued_jobs, stored.running_jobs, stored.unfinished_uploads,
      Bar(used, used + available), used, available);
}

std::string StoredJson(const ServerStatus::Stored& stored) {
  return absl::StrFormat(
      R"(,"stored":{"disk_used_bytes":%d,"disk_available_bytes":%d,"uploads_unfinished":%d,)"
      R"("jobs_queued":%d,"jobs_running":%d})",
      stored.disk_used_bytes, stored.disk_available_bytes, stored.unfinished_uploads,
      stored.queued_jobs, stored.running_jobs);
}

TopRates RatesBetween(const ServerStatus& before, const ServerStatus& after) {
  const double seconds = InSeconds(after.uptime - before.uptime);
  const auto rate = [&](uint64_t ServerStatus::*sum) {
    return Rate(before.*sum, after.*sum, seconds);
  };
  TopRates rates;
  rates.calls = rate(&ServerStatus::calls);
  rates.jobs = rate(&ServerStatus::jobs);
  rates.points = rate(&ServerStatus::object_points);
  if (seconds > 0) {
    rates.processors = InSeconds(after.processor_time - before.processor_time) / seconds;
  }
  return rates;
}

// A screen of text, and a line of JSON. Without rates there was only one query.
std::string TopText(const std::string& address, const ServerStatus& status,
                    const std::optional<TopRates>& rates) {
  std::string text =
      absl::StrFormat("%s   bccskel-server %s   up %s%s\n", address, status.server_version,
                      UptimeText(status.uptime), status.draining ? "   draining" : "");
  absl::StrAppendFormat(&text, "jobs        %d admitted: %d running, %d waiting for threads\n",
                        status.admitted_jobs, status.running_jobs, status.waiting_jobs);
  if (status.stored.has_value()) text += StoredText(*status.stored);
  absl::StrAppendFormat(&text, "threads     %s %d of %d\n",
                        Bar(status.busy_threads, status.threads), status.busy_threads,
                        status.threads);
  absl::StrAppendFormat(&text, "reserved    %s %.0f of %.0f MiB\n",
                        Bar(Mebibytes(status.admitted_bytes), Mebibytes(status.max_admitted_bytes)),
                        Mebibytes(status.admitted_bytes), Mebibytes(status.max_admitted_bytes));
  absl::StrAppendFormat(&text, "process     %.0f MiB, %d open files\n",
                        Mebibytes(status.resident_bytes), status.open_files);
  if (rates.has_value()) text += RatesText(*rates);
  absl::StrAppendFormat(
      &text, "since start %d calls (%d failed)   %d jobs (%d failed)   %.2f million points\n",
      status.calls, status.failed_calls, status.jobs, status.failed_jobs,
      static_cast<double>(status.object_points) / 1e6);
  return text;
}

std::string TopJson(const ServerStatus& status, const std::optional<TopRates>& rates) {
  std::string json = absl::StrFormat(
      R"({"server_version":%s,"uptime_seconds":%.3f,"draining":%s,"jobs":{"admitted":%d,)"
      R"("waiting":%d,"running":%d},"threads":%d,"busy_threads":%d,"admitted_bytes":%d,)"
      R"("max_admitted_bytes":%d,"resident_bytes":%d,"open_files":%d,"processor_seconds":%.3f,)"
      R"("totals":{"calls":%d,"failed_calls":%d,"jobs":%d,"failed_jobs":%d,"object_points":%d})",
      JsonString(status.server_version), InSeconds(status.uptime),
      status.draining ? "true" : "false", status.admitted_jobs, status.waiting_jobs,
      status.running_jobs, status.threads, status.busy_threads, status.admitted_bytes,
      status.max_admitted_bytes, status.resident_bytes, status.open_files,
      InSeconds(status.processor_time), status.calls, status.failed_calls, status.jobs,
      status.failed_jobs, status.object_points);
  if (status.stored.has_value()) json += StoredJson(*status.stored);
  if (rates.has_value()) {
    absl::StrAppendFormat(
        &json, R"(,"per_second":{"calls":%.3f,"jobs":%.3f,"object_points":%.1f,"processors":%.3f})",
        rates->calls, rates->jobs, rates->points, rates->processors);
  }
  absl::StrAppend(&json, "}\n");
  return json;
}

constexpr std::chrono::milliseconds kPatience = std::chrono::seconds(10);

absl::StatusOr<std::unique_ptr<client::Operations>> Open(const TopArguments& arguments) {
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(arguments.server));
  return client::Operations::Create(endpoint);
}

ExitCode Show(const TopArguments& arguments, const client::ServerStatus& status,
              const std::optional<TopRates>& rates) {
  if (arguments.common.summary == SummaryStyle::kJson) return Print(TopJson(status, rates));
  // On a terminal each screen replaces the last.
  const bool clear = arguments.repeat == TopRepeat::kForever && isatty(STDOUT_FILENO) == 1;
  const std::string screen = clear ? "\x1b[H\x1b[2J" : "";
  return Print(screen + TopText(arguments.server.address, status, rates));
}

}  // namespace

void AddTop(CLI::App& command, TopArguments& arguments) {
  AddServer(command, arguments.server);
  command.add_flag_callback(
      "--once", [&arguments] { arguments.repeat = TopRepeat::kOnce; }, "Print one update and exit");
  AddSeconds(command, "--interval", arguments.interval, "Seconds between updates (default 1)");
  AddJson(command, arguments.common);
}

ExitCode Run(const TopArguments& arguments, const std::stop_token& stop) {
  const auto operations = Open(arguments);
  if (!operations.ok()) return FailOnServer(arguments.server, operations.status());
  std::optional<client::ServerStatus> before;
  while (true) {
    const absl::StatusOr<client::ServerStatus> status = (*operations)->GetStatus(kPatience, stop);
    if (!status.ok()) return FailOnServer(arguments.server, status.status());
    std::optional<TopRates> rates;
    if (before.has_value()) rates = RatesBetween(*before, *status);
    const ExitCode shown = Show(arguments, *status, rates);
    if (shown != ExitCode::kOk || arguments.repeat == TopRepeat::kOnce) return shown;
    before = *status;
    client::PauseFor(arguments.interval, stop);
    if (stop.stop_requested()) return ExitCode::kInterrupted;
  }
}

}  // namespace bccskel::cli
