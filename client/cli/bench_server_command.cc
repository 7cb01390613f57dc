#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/call_options.h"
#include "client/cli/arguments.h"
#include "client/cli/bench_core.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/option_values.h"
#include "client/cli/summaries.h"
#include "client/encoded_volume.h"
#include "client/endpoint.h"
#include "client/skeletonize_client.h"
#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize.h"
#include "core/pipeline/stage_timings.h"
#include "proto/wire/error_details.h"

namespace bccskel::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Times of one call.
struct ServedCall {
  std::chrono::nanoseconds latency{0};  // from the first byte to the checked skeleton
  client::CallTimes way;
  StageTimings stages;
};

// Measurements of a server with a number of concurrent clients.
struct ServerMeasurement {
  int clients = 0;
  uint64_t points = 0;                 // of the volume
  uint64_t volume_bytes = 0;           // as sent
  std::chrono::nanoseconds encode{0};  // of the volume, before all calls
  double seconds = 0;
  uint64_t refused = 0;           // UNAVAILABLE, repeated after a pause
  std::vector<ServedCall> calls;  // successful calls in ascending order of latency
};

// A part of a served call's time.
struct TimeShare {
  const char* name;
  std::function<std::chrono::nanoseconds(const ServedCall&)> of;
};

// The measurements of one client.
struct Share {
  absl::Status status;
  uint64_t refused = 0;
  std::vector<ServedCall> calls;
};

class Client {
 public:
  Client(std::unique_ptr<client::Stub> stub, const client::EncodedVolume& volume,
         const SkeletonizeOptions& skeletonize, const std::stop_token& stop)
      : stub_(std::move(stub)), volume_(volume), skeletonize_(skeletonize), stop_(stop) {}

  // Errors: see MeasureServer(); CANCELLED.
  absl::Status CallOnce() {
    ServedCall call;
    client::CallOptions options;
    options.skeletonize = skeletonize_;
    options.stop = stop_;
    options.on_times = [&call](const client::CallTimes& times) { call.way = times; };
    const auto deadline = client::Stub::Clock::now() + options.timeout;
    while (true) {
      const Clock::time_point start = Clock::now();
      const auto result = stub_->Skeletonize(volume_, options, deadline);
      call.latency = Clock::now() - start;
      if (result.ok()) {
        call.stages = result->timings;
        share_.calls.push_back(call);
      }
      const absl::Status& status = result.status();
      const auto pause = wire::RetryDelayOf(status);
      if (!absl::IsUnavailable(status) || !pause.has_value()) return status;
      ++share_.refused;
      client::PauseFor(milliseconds(absl::ToInt64Milliseconds(*pause)), stop_);
    }
  }

  // At least once.
  void CallUntil(Clock::time_point end) {
    do {
      share_.status = CallOnce();
    } while (share_.status.ok() && Clock::now() < end);
  }

  Share& share() { return share_; }

 private:
  const std::unique_ptr<client::Stub> stub_;
  const client::EncodedVolume& volume_;
  const SkeletonizeOptions& skeletonize_;
  const std::stop_token stop_;
  Share share_;
};

absl::StatusOr<std::vector<std::unique_ptr<Client>>> Connect(const client::Endpoint& endpoint,
                                                             const client::EncodedVolume& volume,
                                                             const SkeletonizeOptions& options,
                                                             int clients,
                                                             const std::stop_token& stop) {
  client::Endpoint alone = endpoint;
  alone.sharing = client::Endpoint::Sharing::kAlone;
  std::vector<std::unique_ptr<Client>> all;
  for (int n = 0; n < clients; ++n) {
    BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<client::Stub> stub, client::MakeGrpcStub(alone));
    all.push_back(std::make_unique<Client>(std::move(stub), volume, options, stop));
    BCCSKEL_RETURN_IF_ERROR(all.back()->CallOnce());
    all.back()->share() = Share();
  }
  return all;
}

// In the order in which they begin. Decoding overlaps with the upload; "rest" is neither upload,
// stage nor download: the end of decoding, the queue, handover and the check.
std::vector<TimeShare> SharesOfCalls() {
  std::vector<TimeShare> shares = {
      {"upload", [](const ServedCall& call) { return call.way.upload; }},
      {"queue", [](const ServedCall& call) { return call.way.queue; }},
      {"decode", [](const ServedCall& call) { return call.way.decode; }}};
  for (const Stage& stage : kStages) {
    shares.push_back({stage.name, [&stage](const ServedCall& call) {
                        return std::chrono::nanoseconds(call.stages.*stage.time);
                      }});
  }
  shares.push_back({"download", [](const ServedCall& call) { return call.way.download; }});
  shares.push_back({"rest", [](const ServedCall& call) {
                      return call.latency - call.way.upload - call.stages.total - call.way.download;
                    }});
  return shares;
}

// The median over the calls. Needs: at least one call.
std::chrono::nanoseconds MedianOf(const ServerMeasurement& measured, const TimeShare& share) {
  std::vector<std::chrono::nanoseconds> values;
  for (const ServedCall& call : measured.calls) values.push_back(share.of(call));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// The latency that `share` (0 to 1) of the calls did not exceed. Needs: at least one call.
std::chrono::nanoseconds Percentile(const ServerMeasurement& measured, double share) {
  const auto last = static_cast<double>(measured.calls.size() - 1);
  return measured.calls[static_cast<size_t>(share * last + 0.5)].latency;
}

// Each client has its own connection and sends `volume` with `options` again as soon as it has the
// skeleton, which it checks as usual. The first call of each client does not count.
// Errors: of the first call that fails with anything but UNAVAILABLE with a delay.
absl::StatusOr<ServerMeasurement> MeasureServer(const client::Endpoint& endpoint,
                                                const client::EncodedVolume& volume,
                                                const SkeletonizeOptions& options, int clients,
                                                milliseconds duration,
                                                const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(auto all, Connect(endpoint, volume, options, clients, stop));
  const Clock::time_point start = Clock::now();
  {
    std::vector<std::jthread> threads;
    for (auto& client : all) {
      threads.emplace_back([&client, end = start + duration] { client->CallUntil(end); });
    }
  }
  ServerMeasurement measured;
  measured.clients = clients;
  measured.volume_bytes = volume.bytes.size();
  measured.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  for (auto& client : all) {
    const Share& share = client->share();
    BCCSKEL_RETURN_IF_ERROR(share.status);
    measured.refused += share.refused;
    measured.calls.insert(measured.calls.end(), share.calls.begin(), share.calls.end());
  }
  std::ranges::sort(measured.calls, {}, &ServedCall::latency);
  return measured;
}

double Milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

double CallsPerSecond(const ServerMeasurement& measured) {
  return static_cast<double>(measured.calls.size()) / measured.seconds;
}

double PointsPerSecond(const ServerMeasurement& measured) {
  return CallsPerSecond(measured) * static_cast<double>(measured.points);
}

// The median call and the encoding before it, per point.
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

// The parts of a call's time, one column per measurement.
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

// The fastest of a few runs, because the calls are warm, too.
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

void AddBenchServer(CLI::App& command, BenchServerArguments& arguments) {
  AddServer(command, arguments.server);
  command
      .add_option("--clients", arguments.clients,
                  "Clients at the same time, each with its own connection (default 1,2,4,8)")
      ->delimiter(',')
      ->check(Within(1, 1024))
      ->option_text("N,...");
  command
      .add_option_function<std::vector<std::string>>(
          "--points",
          [&arguments](const std::vector<std::string>& given) {
            arguments.points.clear();
            for (const std::string& count : given) {
              arguments.points.push_back(
                  ReadCount<uint64_t>("--points", count, kMinShapePoints, kMaxShapePoints));
            }
          },
          "Points of the volume (default 10000,850000)")
      ->delimiter(',')
      ->option_text("N,...");
  AddBenchShape(command, arguments.shape, "What the volume is (default ball)");
  AddBenchMethod(command, arguments.method, arguments.distance, "How to thin (default symmetric)");
  AddChoice<VolumeEncoding>(command, "--encoding", arguments.encoding,
                            "Encoding of volumes on the wire (default raw)",
                            {{"raw", VolumeEncoding::kRawPlanes},
                             {"bricks", VolumeEncoding::kBricks},
                             {"openexr", VolumeEncoding::kOpenExr}});
  AddSeconds(command, "--seconds", arguments.duration, "For each combination (default 5)");
  AddJson(command, arguments.common);
}

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
