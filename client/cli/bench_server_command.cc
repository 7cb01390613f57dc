#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/bench_core.h"
#include "client/cli/bench_objects.h"
#include "client/cli/bench_server.h"
#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/json_text.h"
#include "client/cli/server_arguments.h"
#include "client/encoded_volume.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

double Milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

double CallsPerSecond(const ServerMeasurement& measured) {
  return static_cast<double>(measured.calls.size()) / measured.seconds;
}

double PointsPerSecond(const ServerMeasurement& measured) {
  return CallsPerSecond(measured) * static_cast<double>(measured.points);
}

// A call in the middle and the encoding before it, by points.
double NanosecondsPerPoint(const ServerMeasurement& measured) {
  const auto time = measured.encode + Percentile(measured, 0.5);
  return static_cast<double>(time.count()) / static_cast<double>(measured.points);
}

std::string Row(const ServerMeasurement& measured) {
  const auto ms = [&](double share) { return Milliseconds(Percentile(measured, share)); };
  return absl::StrFormat("%8d%10d%9d%9d%10.1f%10.2f%9.2f%9.2f%9.2f%9.2f%10.2f\n", measured.clients,
                         measured.points, measured.calls.size(), measured.refused,
                         CallsPerSecond(measured), PointsPerSecond(measured) / 1e6, ms(0.5),
                         ms(0.9), ms(0.99), ms(1), NanosecondsPerPoint(measured));
}

std::string Heading() {
  return absl::StrFormat("%8s%10s%9s%9s%10s%10s%9s%9s%9s%9s%10s\n", "clients", "points", "calls",
                         "refused", "calls/s", "Mpts/s", "p50 ms", "p90 ms", "p99 ms", "max ms",
                         "ns/point");
}

// What a call's time consists of, a column for each measurement.
std::string SharesTable(const std::vector<ServerMeasurement>& all) {
  std::string table = absl::StrFormat("\n%-12s", "median ms");
  for (const ServerMeasurement& measured : all) {
    absl::StrAppendFormat(&table, "%16s", absl::StrCat(measured.clients, " x ", measured.points));
  }
  const auto add_row = [&](const char* name, const auto& of) {
    absl::StrAppendFormat(&table, "\n%-12s", name);
    for (const ServerMeasurement& measured : all) {
      absl::StrAppendFormat(&table, "%16.3f", Milliseconds(of(measured)));
    }
  };
  add_row("encode", [](const ServerMeasurement& measured) { return measured.encode; });
  for (const TimeShare& share : SharesOfCalls()) {
    add_row(share.name, [&](const ServerMeasurement& m) { return MedianOf(m, share); });
  }
  return table + '\n';
}

std::string SharesJson(const ServerMeasurement& measured) {
  std::string json = absl::StrFormat(R"({"encode":%.4f)", Milliseconds(measured.encode));
  for (const TimeShare& share : SharesOfCalls()) {
    absl::StrAppendFormat(&json, R"(,"%s":%.4f)", share.name,
                          Milliseconds(MedianOf(measured, share)));
  }
  return json + "}";
}

std::string Json(const ServerMeasurement& measured) {
  const auto ms = [&](double share) { return Milliseconds(Percentile(measured, share)); };
  return absl::StrFormat(
      R"({"clients":%d,"points":%d,"volume_bytes":%d,"seconds":%.3f,"calls":%d,"refused":%d,)"
      R"("calls_per_second":%.3f,"points_per_second":%.0f,"ns_per_point":%.3f,)"
      R"("latency_ms":{"p50":%.4f,"p90":%.4f,"p99":%.4f,"max":%.4f},"median_ms":%s})",
      measured.clients, measured.points, measured.volume_bytes, measured.seconds,
      measured.calls.size(), measured.refused, CallsPerSecond(measured), PointsPerSecond(measured),
      NanosecondsPerPoint(measured), ms(0.5), ms(0.9), ms(0.99), ms(1), SharesJson(measured));
}

// The best of a few runs, as the calls are warm, too.
absl::StatusOr<client::EncodedVolume> EncodeInTime(const Volume& volume, VolumeEncoding encoding,
                                                   const std::stop_token& stop,
                                                   std::chrono::nanoseconds& best) {
  constexpr int kRuns = 3;
  best = std::chrono::nanoseconds::max();
  absl::StatusOr<client::EncodedVolume> encoded;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    encoded = client::EncodeForSending(volume, encoding, stop);
    BCCSKEL_RETURN_IF_ERROR(encoded.status());
    best = std::min<std::chrono::nanoseconds>(best, std::chrono::steady_clock::now() - start);
  }
  return encoded;
}

// One size of volume, all numbers of clients.
absl::Status MeasureSize(const BenchServerArguments& arguments, const client::Endpoint& endpoint,
                         uint64_t points, const std::stop_token& stop,
                         std::vector<ServerMeasurement>& all) {
  BCCSKEL_ASSIGN_OR_RETURN(const Volume volume, MakeBenchObject(arguments.shape, points));
  std::chrono::nanoseconds encode{0};
  BCCSKEL_ASSIGN_OR_RETURN(const client::EncodedVolume encoded,
                           EncodeInTime(volume, arguments.encoding, stop, encode));
  SkeletonizeOptions options;
  options.thinning.method = arguments.method;
  options.distance = DistanceFor(arguments.method, arguments.distance);
  for (const int clients : arguments.clients) {
    BCCSKEL_ASSIGN_OR_RETURN(
        ServerMeasurement measured,
        MeasureServer(endpoint, encoded, options, clients, arguments.duration, stop));
    measured.points = volume.PointCount();
    measured.encode = encode;
    all.push_back(std::move(measured));
    if (arguments.common.summary == SummaryStyle::kText) Print(Row(all.back()));
  }
  return absl::OkStatus();
}

absl::Status MeasureAll(const BenchServerArguments& arguments, const std::stop_token& stop,
                        std::vector<ServerMeasurement>& all) {
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(arguments.server));
  if (arguments.common.summary == SummaryStyle::kText) Print(Heading());
  for (const uint64_t points : arguments.points) {
    BCCSKEL_RETURN_IF_ERROR(MeasureSize(arguments, endpoint, points, stop, all));
  }
  return absl::OkStatus();
}

}  // namespace

ExitCode Run(const BenchServerArguments& arguments, const std::stop_token& stop) {
  std::vector<ServerMeasurement> all;
  const absl::Status status = MeasureAll(arguments, stop, all);
  if (!status.ok()) return FailOnServer(arguments.server, status);
  if (arguments.common.summary == SummaryStyle::kText) return Print(SharesTable(all));
  std::string json =
      absl::StrCat("{\"server\":", JsonString(arguments.server.address), ",\"measured\":[");
  for (const ServerMeasurement& measured : all) {
    absl::StrAppend(&json, json.back() == '[' ? "" : ",", Json(measured));
  }
  return Print(absl::StrCat(json, "]}\n"));
}

}  // namespace bccskel::cli
