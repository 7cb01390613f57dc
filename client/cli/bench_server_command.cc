#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/bench_server.h"
#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/json_text.h"
#include "client/cli/server_arguments.h"
#include "client/encoded_volume.h"
#include "core/exec/status_macros.h"
#include "core/shapes/shapes.h"

namespace bccskel::cli {
namespace {

double Milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

double CallsPerSecond(const ServerMeasurement& measured) {
  return static_cast<double>(measured.latency.size()) / measured.seconds;
}

double PointsPerSecond(const ServerMeasurement& measured) {
  return CallsPerSecond(measured) * static_cast<double>(measured.points);
}

std::string Row(const ServerMeasurement& measured) {
  const auto ms = [&](double share) { return Milliseconds(Percentile(measured, share)); };
  return absl::StrFormat("%8d%10d%9d%9d%10.1f%10.2f%9.2f%9.2f%9.2f%9.2f\n", measured.clients,
                         measured.points, measured.latency.size(), measured.refused,
                         CallsPerSecond(measured), PointsPerSecond(measured) / 1e6, ms(0.5),
                         ms(0.9), ms(0.99), ms(1));
}

std::string Heading() {
  return absl::StrFormat("%8s%10s%9s%9s%10s%10s%9s%9s%9s%9s\n", "clients", "points", "calls",
                         "refused", "calls/s", "Mpts/s", "p50 ms", "p90 ms", "p99 ms", "max ms");
}

std::string Json(const ServerMeasurement& measured) {
  const auto ms = [&](double share) { return Milliseconds(Percentile(measured, share)); };
  return absl::StrFormat(
      R"({"clients":%d,"points":%d,"volume_bytes":%d,"seconds":%.3f,"calls":%d,"refused":%d,)"
      R"("calls_per_second":%.3f,"points_per_second":%.0f,)"
      R"("latency_ms":{"p50":%.4f,"p90":%.4f,"p99":%.4f,"max":%.4f}})",
      measured.clients, measured.points, measured.volume_bytes, measured.seconds,
      measured.latency.size(), measured.refused, CallsPerSecond(measured),
      PointsPerSecond(measured), ms(0.5), ms(0.9), ms(0.99), ms(1));
}

// One size of volume, all numbers of clients.
absl::Status MeasureSize(const BenchServerArguments& arguments, const client::Endpoint& endpoint,
                         uint64_t points, const std::stop_token& stop,
                         std::vector<ServerMeasurement>& all) {
  BCCSKEL_ASSIGN_OR_RETURN(const Volume volume, GenerateShape(Shape::kBall, {.points = points}));
  BCCSKEL_ASSIGN_OR_RETURN(const client::EncodedVolume encoded,
                           client::EncodeForSending(volume, arguments.encoding, stop));
  for (const int clients : arguments.clients) {
    BCCSKEL_ASSIGN_OR_RETURN(ServerMeasurement measured,
                             MeasureServer(endpoint, encoded, clients, arguments.duration, stop));
    measured.points = volume.PointCount();
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
  if (!status.ok()) return FailOnServer(arguments.server.address, status);
  if (arguments.common.summary == SummaryStyle::kText) return ExitCode::kOk;
  std::string json =
      absl::StrCat("{\"server\":", JsonString(arguments.server.address), ",\"measured\":[");
  for (const ServerMeasurement& measured : all) {
    absl::StrAppend(&json, json.back() == '[' ? "" : ",", Json(measured));
  }
  return Print(absl::StrCat(json, "]}\n"));
}

}  // namespace bccskel::cli
