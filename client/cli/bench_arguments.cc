#include "client/cli/bench_arguments.h"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/bench_objects.h"
#include "client/cli/choice_option.h"
#include "client/cli/count_option.h"
#include "core/exec/instruction_sets.h"
#include "core/import/shapes/shapes.h"
#include "core/pipeline/option_words.h"

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
  CLI::Option* shape = AddBenchShape(core, arguments.shape, "What to thin (default ball)");
  core.add_option("--object", arguments.object, "Mesh, volume or image to thin instead")
      ->excludes(shape)
      ->option_text("FILE");
  core.add_option_function<std::string>(
          "--points",
          [&arguments](const std::string& given) { arguments.points = ReadBenchPoints(given); },
          "Points that a shape or a mesh shall have (default 850000)")
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
  AddBenchMethod(core, arguments.method, arguments.distance, "How to thin (default directional)");
}

}  // namespace

void AddBenchCore(CLI::App& command, BenchCoreArguments& arguments) {
  AddObject(command, arguments);
  AddEngine(command, arguments);
  command.add_option("--repeat", arguments.repeat, "Warm runs, after a cold one (default 11)")
      ->check(CLI::Range(1, 100'000))
      ->option_text("N");
  command.add_flag_callback(
      "--json", [&arguments] { arguments.common.summary = SummaryStyle::kJson; },
      "Print the summary as one JSON object");
}

uint64_t ReadBenchPoints(const std::string& given) {
  const auto points = ReadCount<uint64_t>("--points", given);
  if (points >= kMinShapePoints && points <= kMaxShapePoints) return points;
  throw CLI::ValidationError("--points " + given + ": must be within " +
                             std::to_string(kMinShapePoints) + " and " +
                             std::to_string(kMaxShapePoints));
}

CLI::Option* AddBenchShape(CLI::App& command, std::string& shape, const char* description) {
  return AddChoice<std::string>(command, "--shape", shape, description, Themselves(kBenchObjects));
}

void AddBenchMethod(CLI::App& command, ThinningMethod& method,
                    std::optional<DistanceKind>& distance, const char* description) {
  AddChoice<ThinningMethod>(command, "--method", method, description, Choices(kMethodWords));
  AddChoice<DistanceKind>(
      command, "--distance", [&distance](DistanceKind chosen) { distance = chosen; },
      "How distances are measured (default with symmetric euclidean, otherwise chamfer)",
      Choices(kDistanceWords));
}

}  // namespace bccskel::cli
