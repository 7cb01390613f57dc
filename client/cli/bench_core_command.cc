#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/cli/arguments.h"
#include "client/cli/bench_core.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/load_object.h"
#include "client/cli/option_values.h"
#include "client/cli/summaries.h"
#include "client/export/picture/caption.h"
#include "client/export/text.h"
#include "core/exec/instruction_sets.h"
#include "core/pipeline/option_words.h"

namespace bccskel::cli {
namespace {

using exporting::GroupedDigits;
using exporting::Text;

absl::StatusOr<Volume> ObjectOf(const BenchCoreArguments& arguments, const exec::Context& context) {
  if (arguments.object.empty()) return MakeBenchObject(arguments.shape, arguments.points);
  return LoadObject(arguments.object, {.points = arguments.points}, {}, context);
}

std::string NameOf(const BenchCoreArguments& arguments) {
  return arguments.object.empty() ? arguments.shape : std::string(FileName(arguments.object));
}

// A measured time in milliseconds.
struct Figure {
  const char* name;
  double (*of)(const StageTimings&);
};
constexpr Figure kCore = {"core", [](const StageTimings& t) { return CoreTime(t).count(); }};
constexpr Figure kWhole = {"whole",
                           [](const StageTimings& t) { return Milliseconds(t.total).count(); }};

template <typename Of>
Spread WarmSpread(const CoreMeasurement& measured, Of of, double factor) {
  std::vector<double> values;
  for (const StageTimings& timings : measured.warm) values.push_back(factor * of(timings));
  return SpreadOf(std::move(values));
}

double StageTime(const Stage& stage, const StageTimings& timings) {
  return Milliseconds(timings.*stage.time).count();
}

double NanosecondsPerPoint(const CoreMeasurement& measured) {
  return 1e6 / static_cast<double>(measured.points);
}

std::string SpreadJson(const Spread& spread) {
  return absl::StrFormat(R"({"min":%.6g,"median":%.6g,"max":%.6g})", spread.min, spread.median,
                         spread.max);
}

std::string StagesJson(const CoreMeasurement& measured) {
  std::string json;
  for (const Stage& stage : kStages) {
    const auto time = [&stage](const StageTimings& timings) { return StageTime(stage, timings); };
    absl::StrAppendFormat(&json, R"(%s"%s":%s)", json.empty() ? "" : ",", stage.name,
                          SpreadJson(WarmSpread(measured, time, 1)));
  }
  return "{" + json + "}";
}

std::string Json(const BenchCoreArguments& arguments, int threads,
                 const CoreMeasurement& measured) {
  const double ns = NanosecondsPerPoint(measured);
  Text text;
  text.Add("{\"method\":\"", WordFor(kMethodWords, arguments.method), "\",\"distance\":\"",
           WordFor(kDistanceWords, DistanceFor(arguments.method, arguments.distance)),
           "\",\"isa\":\"", exec::ChosenInstructionSet(), "\",\"threads\":", threads,
           ",\"shape\":", JsonString(NameOf(arguments)), ",\"points\":", measured.points,
           ",\"bricks\":", measured.bricks, ",\"repeat\":", arguments.repeat);
  text.Add(",\"ns_per_point\":", SpreadJson(WarmSpread(measured, kCore.of, ns)),
           ",\"whole_ns_per_point\":", SpreadJson(WarmSpread(measured, kWhole.of, ns)));
  text.Add(",\"cold\":{\"ns_per_point\":", absl::StrFormat("%.6g", ns * kCore.of(measured.cold)),
           ",\"whole_ns_per_point\":", absl::StrFormat("%.6g", ns * kWhole.of(measured.cold)),
           "},\"stages\":", StagesJson(measured), ",\"peak_bytes\":", measured.peak_bytes,
           ",\"sha256\":\"", measured.sha256, "\"}\n");
  return std::move(text).Take();
}

std::string TableRow(const char* name, const Spread& warm, double cold, const char* unit) {
  return absl::StrFormat("%-12s%10.3f%10.3f%10.3f%10.3f  %s\n", name, warm.min, warm.median,
                         warm.max, cold, unit);
}

std::string Table(const CoreMeasurement& measured) {
  const double ns = NanosecondsPerPoint(measured);
  std::string table =
      absl::StrFormat("%-12s%10s%10s%10s%10s\n", "", "min", "median", "max", "cold");
  for (const Figure& figure : {kCore, kWhole}) {
    table += TableRow(figure.name, WarmSpread(measured, figure.of, ns),
                      ns * figure.of(measured.cold), "ns per point");
  }
  for (const Stage& stage : kStages) {
    const auto time = [&stage](const StageTimings& timings) { return StageTime(stage, timings); };
    table += TableRow(stage.name, WarmSpread(measured, time, 1), time(measured.cold), "ms");
  }
  return table;
}

std::string PeakText(const CoreMeasurement& measured) {
  if (!measured.peak_bytes.has_value()) return "not known on this system";
  const auto bytes = static_cast<double>(*measured.peak_bytes);
  const auto lattice_points = static_cast<double>(measured.bricks * kBrickPoints);
  return absl::StrFormat("%.1f MB, %.2f bytes per lattice point of the object's bricks",
                         bytes / 1e6, bytes / lattice_points);
}

std::string Summary(const BenchCoreArguments& arguments, int threads,
                    const CoreMeasurement& measured) {
  Text text;
  text.Add("object:      ", NameOf(arguments), ", ", GroupedDigits(measured.points), " points in ",
           GroupedDigits(measured.bricks), " bricks\n");
  text.Add("engine:      ", WordFor(kMethodWords, arguments.method), ", ",
           WordFor(kDistanceWords, DistanceFor(arguments.method, arguments.distance)),
           " distances, ", exec::ChosenInstructionSet(), ", ", threads,
           threads == 1 ? " thread, " : " threads, ", arguments.repeat, " warm runs\n\n");
  text.Add(Table(measured), "\npeak memory: ", PeakText(measured),
           "\nsha256:      ", measured.sha256, '\n');
  return std::move(text).Take();
}

void AddObject(CLI::App& core, BenchCoreArguments& arguments) {
  CLI::Option* shape = AddBenchShape(core, arguments.shape, "What to thin (default ball)");
  core.add_option("--object", arguments.object, "Mesh, volume or image to thin instead")
      ->excludes(shape)
      ->option_text("FILE");
  AddCount(core, "--points", arguments.points,
           "Number of points of a shape or a mesh (default 850000)", kMinShapePoints,
           kMaxShapePoints);
}

void AddEngine(CLI::App& core, BenchCoreArguments& arguments) {
  AddThreads(core, arguments.common, kThreadsHere);
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
      ->check(Within(1, 100'000))
      ->option_text("N");
  AddJson(command, arguments.common);
}

ExitCode Run(const BenchCoreArguments& arguments, const std::stop_token& stop) {
  if (!exec::ChooseInstructionSet(arguments.instruction_set)) return ExitCode::kUsage;
  LocalTeam team(arguments.common.threads, stop);
  const absl::StatusOr<Volume> object = ObjectOf(arguments, team.context());
  if (!object.ok()) return Fail(object.status());
  const SkeletonizeOptions options = {
      .thinning = {.method = arguments.method},
      .distance = DistanceFor(arguments.method, arguments.distance)};
  const auto measured = MeasureCore(*object, options, arguments.repeat, team.context());
  if (!measured.ok()) return Fail(measured.status());
  const int threads = team.context().threads();
  return Print(arguments.common.summary == SummaryStyle::kJson
                   ? Json(arguments, threads, *measured)
                   : Summary(arguments, threads, *measured));
}

}  // namespace bccskel::cli
