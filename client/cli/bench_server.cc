#include "client/cli/bench_server.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "client/connection.h"
#include "core/exec/status_macros.h"
#include "proto/wire/error_details.h"

namespace bccskel::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// What one client sees.
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

  void CallUntil(Clock::time_point end) {
    while (share_.status.ok() && Clock::now() < end) share_.status = CallOnce();
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

}  // namespace

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

std::chrono::nanoseconds MedianOf(const ServerMeasurement& measured, const TimeShare& share) {
  std::vector<std::chrono::nanoseconds> values;
  for (const ServedCall& call : measured.calls) values.push_back(share.of(call));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::chrono::nanoseconds Percentile(const ServerMeasurement& measured, double share) {
  const auto last = static_cast<double>(measured.calls.size() - 1);
  return measured.calls[static_cast<size_t>(share * last + 0.5)].latency;
}

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

}  // namespace bccskel::cli
