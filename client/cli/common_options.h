#ifndef BCCSKEL_CLIENT_CLI_COMMON_OPTIONS_H_
#define BCCSKEL_CLIENT_CLI_COMMON_OPTIONS_H_

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"

// Options that several commands have. Only files that add options include this and CLI11, which is
// slow to compile.

namespace bccskel::cli {

inline constexpr const char* kThreadsHere = "Threads to use; 0 (default) means all of this machine";
inline constexpr const char* kThreadsBoth =
    "Threads to use, here and on the server; 0 (default) means all of this machine and as many as "
    "the server grants";

// --json
void AddJson(CLI::App& command, CommonArguments& common);
// --threads
void AddThreads(CLI::App& command, CommonArguments& common, const char* description);
// --threads of this machine, --progress and --json
void AddCommonHere(CLI::App& command, CommonArguments& common);
// --progress
void AddProgress(CLI::App& command, ProgressStyle& progress);
CLI::Option* AddSeconds(CLI::App& command, const char* name, std::chrono::milliseconds& time,
                        const char* description);

// Adds --server and its companions.
void AddServer(CLI::App& command, ServerArguments& server);

// --server and its companions, and --local: where to compute. kLocal unless a server is given.
void AddPlace(CLI::App& command, ServerArguments& server, Place& place);

// The options of skeletons, --threads, --progress, --timeout and --json.
void AddComputing(CLI::App& command, ComputeArguments& arguments);

// Reads the files.
// Errors: NOT_FOUND for a file that cannot be read; INVALID_ARGUMENT for a token file without a
//         token.
absl::StatusOr<client::Endpoint> EndpointOf(const ServerArguments& server);

// A file as the positional argument `name`.
void AddInput(CLI::App& command, const char* name, std::string& path, const char* description);
// --output: a file whose name ends in one of `endings`.
void AddOutput(CLI::App& command, std::string& path, const char* what,
               const std::vector<std::string>& endings);
// --output of skeletons, any number of them; `what` describes them, by default all formats.
CLI::Option* AddOutputs(CLI::App& command, std::vector<std::string>& outputs,
                        const std::string& what = "");

// RESULT, and its object with the options for reading it.
void AddResult(CLI::App& command, std::string& path);
enum class ObjectNeed { kRequired, kOptional };
void AddResultAndObject(CLI::App& command, ResultArguments& arguments, ObjectNeed need);

// Options of the benchmarks.
CLI::Option* AddBenchShape(CLI::App& command, std::string& shape, const char* description);
void AddBenchMethod(CLI::App& command, ThinningMethod& method,
                    std::optional<DistanceKind>& distance, const char* description);
// Choices in which each name stands for itself.
template <typename Names>
std::vector<std::pair<std::string, std::string>> Themselves(const Names& names) {
  std::vector<std::pair<std::string, std::string>> words;
  for (const auto& name : names) words.emplace_back(name, name);
  return words;
}

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_COMMON_OPTIONS_H_
