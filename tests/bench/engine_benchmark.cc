#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/bench_core.h"
#include "core/exec/instruction_sets.h"
#include "core/exec/worker_team.h"
#include "core/pipeline/skeletonize.h"

// The engine, warm: one run per repetition after one that is not timed. The time of a row is the
// core's; whole, stages and bytes are counters, and the label is the skeleton's SHA-256.

namespace bccskel {
namespace {

constexpr uint64_t kSizes[] = {10'000, 100'000, 850'000, 8'000'000, 64'000'000};
constexpr int kThreads[] = {1, 2};
const SkeletonizeOptions kPaper = {.thinning = {.method = ThinningMethod::kDirectional},
                                   .distance = DistanceKind::kChamfer};

struct Row {
  std::string object;
  uint64_t points;
  int threads;
  std::string instruction_set;

  std::string Name() const {
    return object + "/" + std::to_string(points) + "/threads:" + std::to_string(threads) + "/" +
           instruction_set;
  }
};

// Made when first asked for, and kept: repetitions of all rows take turns.
const absl::StatusOr<Volume>& ObjectOf(const Row& row) {
  static auto& objects = *new std::map<std::pair<std::string, uint64_t>, absl::StatusOr<Volume>>;
  const auto key = std::pair(row.object, row.points);
  const auto found = objects.find(key);
  if (found != objects.end()) return found->second;
  return objects.emplace(key, cli::MakeBenchObject(row.object, row.points)).first->second;
}

void AddCounters(const Volume& object, const SkeletonizeResult& result, benchmark::State& state) {
  const auto points = static_cast<double>(result.object_points);
  state.counters["points"] = points;
  state.counters["bricks"] = static_cast<double>(object.brick_count());
  state.counters["ns_per_point"] = 1e6 / points * cli::CoreTime(result.timings).count();
  state.counters["whole_ns_per_point"] = 1e6 / points * cli::WholeTime(result.timings).count();
  for (const Stage& stage : kStages) {
    const cli::Milliseconds time = result.timings.*stage.time;
    state.counters[std::string(stage.name) + "_ms"] = time.count();
  }
  state.SetLabel(result.sha256);
}

absl::Status Measure(const Row& row, benchmark::State& state) {
  const absl::StatusOr<Volume>& object = ObjectOf(row);
  if (!object.ok()) return object.status();
  exec::ChooseInstructionSet(row.instruction_set);
  exec::WorkerTeam team(row.threads);
  exec::Context context;
  context.team = &team;
  absl::StatusOr<SkeletonizeResult> result = Skeletonize(*object, kPaper, context);
  for (auto _ : state) {
    if (result.ok()) result = Skeletonize(*object, kPaper, context);
    const auto timings = result.ok() ? result->timings : StageTimings();
    state.SetIterationTime(std::chrono::duration<double>(cli::CoreTime(timings)).count());
  }
  if (result.ok()) AddCounters(*object, *result, state);
  return result.status();
}

void Register(const Row& row) {
  benchmark::RegisterBenchmark(row.Name().c_str(),
                               [row](benchmark::State& state) {
                                 const absl::Status status = Measure(row, state);
                                 if (!status.ok()) state.SkipWithError(status.ToString().c_str());
                               })
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

// Every object at every size with the best instruction set; the others on one thread.
void RegisterAll() {
  const std::vector<std::string> sets = exec::SupportedInstructionSets();
  for (const std::string_view object : cli::kBenchObjects) {
    for (const uint64_t points : kSizes) {
      for (const int threads : kThreads) Register({std::string(object), points, threads, sets[0]});
      for (size_t n = 1; n < sets.size(); ++n) Register({std::string(object), points, 1, sets[n]});
    }
  }
}

}  // namespace
}  // namespace bccskel

int main(int argc, char** argv) {
  bccskel::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}
