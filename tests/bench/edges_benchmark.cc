#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "client/export/branch_table.h"
#include "client/export/glb.h"
#include "client/export/graphml.h"
#include "client/export/json.h"
#include "client/export/markups.h"
#include "client/export/obj.h"
#include "client/export/swc.h"
#include "client/export/vtp.h"
#include "core/pipeline/skeletonize.h"

// A net of a million edges: its graph, and the graph in every text format. The bytes of a format
// are a counter.

namespace bccskel {
namespace {

constexpr int32_t kCells = 140;  // along each axis: 1,014,300 edges

// Lines along all axes, two cells apart.
Volume MakeNet() {
  VolumeBuilder builder({kCells, kCells, kCells});
  for (int32_t k = 0; k < kCells; ++k) {
    for (int32_t j = 0; j < kCells; ++j) {
      for (int32_t i = 0; i < kCells; ++i) {
        if ((i % 2 == 0) + (j % 2 == 0) + (k % 2 == 0) >= 2) builder.Add({2 * i, 2 * j, 2 * k});
      }
    }
  }
  return *std::move(builder).Build();
}

const Volume& Net() {
  static const Volume& net = *new Volume(MakeNet());
  return net;
}

const SkeletonizeResult& ResultOfNet() {
  static const SkeletonizeResult& result = *new SkeletonizeResult(*Skeletonize(Net(), {}, {}));
  return result;
}

void MeasureGraph(benchmark::State& state) {
  for (auto _ : state) {
    const SkeletonizeResult result = *Skeletonize(Net(), {}, {});
    state.SetIterationTime(std::chrono::duration<double>(result.timings.graph).count());
    state.counters["edges"] = static_cast<double>(result.graph.edges.size());
  }
}

void Measure(benchmark::State& state, const std::function<std::string()>& write) {
  for (auto _ : state) state.counters["bytes"] = static_cast<double>(write().size());
}

void Register(const char* name, std::function<std::string()> write) {
  benchmark::RegisterBenchmark(
      name, [write = std::move(write)](benchmark::State& state) { Measure(state, write); })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

void RegisterAll() {
  const SkeletonGraph& graph = ResultOfNet().graph;
  benchmark::RegisterBenchmark("million_edges/graph", &MeasureGraph)
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
  Register("million_edges/json", [] { return exporting::JsonText(ResultOfNet(), {}); });
  Register("million_edges/graphml", [&graph] { return exporting::GraphMlText(graph, {}); });
  Register("million_edges/vtp", [&graph] { return exporting::VtpText(graph, {}); });
  Register("million_edges/swc", [&graph] { return exporting::WriteSwc(graph, {}).text; });
  Register("million_edges/csv", [&graph] { return exporting::BranchTableText(graph); });
  Register("million_edges/glb", [&graph] { return *exporting::GlbBytes(graph); });
  Register("million_edges/mrk.json",
           [&graph] { return exporting::WriteMarkups(graph, {}, {}).text; });
  Register("million_edges/obj", [&graph] { return exporting::ObjText(graph); });
}

}  // namespace
}  // namespace bccskel

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  bccskel::RegisterAll();
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}
