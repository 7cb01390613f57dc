#include "client/cli/operations_arguments.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "client/cli/bench_arguments.h"
#include "client/cli/choice_option.h"
#include "client/cli/server_arguments.h"

namespace bccskel::cli {
namespace {

void AddJson(CLI::App& command, CommonArguments& common) {
  command.add_flag_callback(
      "--json", [&common] { common.summary = SummaryStyle::kJson; },
      "Print the summary as one JSON object");
}

void AddSeconds(CLI::App& command, const char* name, std::chrono::milliseconds& time,
                const char* description) {
  command
      .add_option_function<double>(
          name,
          [&time](double seconds) {
            time = std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
          },
          description)
      ->check(CLI::Range(0.001, 1e6))
      ->option_text("SECONDS");
}

}  // namespace

void AddProbe(CLI::App& command, ProbeArguments& arguments) {
  AddServer(command, arguments.server);
  command
      .add_option("--service", arguments.service,
                  "One service, such as bccskel.v1.JobService, instead of the whole server")
      ->option_text("NAME");
  AddSeconds(command, "--timeout", arguments.timeout, "Give up after this time (default 5)");
  AddJson(command, arguments.common);
}

void AddTop(CLI::App& command, TopArguments& arguments) {
  AddServer(command, arguments.server);
  command.add_flag_callback(
      "--once", [&arguments] { arguments.repeat = TopRepeat::kOnce; }, "Show it once");
  AddSeconds(command, "--interval", arguments.interval, "Between two looks (default 1)");
  AddJson(command, arguments.common);
}

void AddBenchServer(CLI::App& command, BenchServerArguments& arguments) {
  AddServer(command, arguments.server);
  command
      .add_option("--clients", arguments.clients,
                  "Clients at the same time, each with its own connection (default 1,2,4,8)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->option_text("N,...");
  command
      .add_option_function<std::vector<std::string>>(
          "--points",
          [&arguments](const std::vector<std::string>& given) {
            arguments.points.clear();
            for (const std::string& count : given) {
              arguments.points.push_back(ReadBenchPoints(count));
            }
          },
          "Points of the volume (default 10000,850000)")
      ->delimiter(',')
      ->option_text("N,...");
  AddBenchShape(command, arguments.shape, "What the volume is (default ball)");
  AddBenchMethod(command, arguments.method, arguments.distance, "How to thin (default symmetric)");
  AddChoice<VolumeEncoding>(command, "--encoding", arguments.encoding,
                            "How volumes travel (default raw)",
                            {{"raw", VolumeEncoding::kRawPlanes},
                             {"bricks", VolumeEncoding::kBricks},
                             {"openexr", VolumeEncoding::kOpenExr}});
  AddSeconds(command, "--seconds", arguments.duration, "For each combination (default 5)");
  AddJson(command, arguments.common);
}

}  // namespace bccskel::cli
