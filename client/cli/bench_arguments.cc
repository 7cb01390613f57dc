#include "client/cli/bench_arguments.h"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/bench_objects.h"
#include "client/cli/choice_option.h"
#include "core/exec/instruction_sets.h"
#include "core/pipeline/option_words.h"
#include "core/shapes/shapes.h"

namespace bccskel::cli {
namespace {

// A word for each name, which stands for itself.
template <typename Names>
std::vector<std::pair<std::string, std::string>> Themselves(const Names& names) {
  std::vector<std::pair<std::string, std::string>> words;
  for (const auto& name : names) words.emplace_back(name, name);
  return words;
}

void AddObject(CLI::App& core, BenchCoreArguments& arguments) {
  CLI::Option* shape = AddChoice<std::string>(
      core, "--shape", arguments.shape, "What to thin (default ball)", Themselves(kBenchObjects));
  core.add_option("--object", arguments.object, "Mesh, volume or image to thin instead")
      ->excludes(shape)
      ->option_text("FILE");
  core.add_option("--points", arguments.points,
                  "Points that a shape or a mesh shall have (default 850000)")
      ->check(CLI::Range(kMinShapePoints, kMaxShapePoints))
      ->option_text("N");
}

void AddEngine(CLI::App& core, BenchCoreArguments& arguments) {
  core.add_option("--threads", arguments.common.threads,
                  "Threads to use; 0 means all of this machine (default)")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  AddChoice<std::string>(core, "--isa", arguments.instruction_set,
                         "Instruction set (default the first)",
                         Themselves(exec::SupportedInstructionSets()));
  AddChoice<ThinningMethod>(core, "--method", arguments.method, "How to thin (default directional)",
                            Choices(kMethodWords));
  AddChoice<DistanceKind>(
      core, "--distance", [&arguments](DistanceKind distance) { arguments.distance = distance; },
      "How distances are measured (default chamfer; with symmetric euclidean)",
      Choices(kDistanceWords));
}

}  // namespace

CLI::App& AddBench(CLI::App& app, BenchCoreArguments& arguments) {
  CLI::App& bench =
      *app.add_subcommand("bench", "Measure the speed of this machine or of a server");
  bench.require_subcommand(1);
  CLI::App& core = *bench.add_subcommand(
      "core", "Time and memory from a volume in memory to its skeleton in memory");
  AddObject(core, arguments);
  AddEngine(core, arguments);
  core.add_option("--repeat", arguments.repeat, "Warm runs, after a cold one (default 11)")
      ->check(CLI::Range(1, 100'000))
      ->option_text("N");
  core.add_flag_callback(
      "--json", [&arguments] { arguments.common.summary = SummaryStyle::kJson; },
      "Print the summary as one JSON object");
  return bench;
}

}  // namespace bccskel::cli
