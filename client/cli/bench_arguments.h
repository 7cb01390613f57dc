#ifndef BCCSKEL_CLIENT_CLI_BENCH_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_BENCH_ARGUMENTS_H_

#include <cstdint>
#include <optional>
#include <string>

#include "client/cli/arguments.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bccskel::cli {

// Adds the options of `bench core`.
void AddBenchCore(CLI::App& command, BenchCoreArguments& arguments);

// What all benchmarks take.
uint64_t ReadBenchPoints(const std::string& given);  // throws CLI::ValidationError
CLI::Option* AddBenchShape(CLI::App& command, std::string& shape, const char* description);
void AddBenchMethod(CLI::App& command, ThinningMethod& method,
                    std::optional<DistanceKind>& distance, const char* description);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_ARGUMENTS_H_
