#ifndef BCCSKEL_CLIENT_CLI_COMMANDS_H_
#define BCCSKEL_CLIENT_CLI_COMMANDS_H_

#include <functional>
#include <stop_token>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/exit_code.h"

namespace bccskel::cli {

// Each runs one command, prints what it has to say and returns how the program ends.
ExitCode Run(const VoxelizeArguments& arguments, const std::stop_token& stop);
ExitCode Run(const SkeletonizeArguments& arguments, const std::stop_token& stop);
ExitCode Run(const LabelsArguments& arguments, const std::stop_token& stop);
ExitCode Run(const InfoArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ViewArguments& arguments, const std::stop_token& stop);
ExitCode Run(const RenderArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ConvertArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ReconstructArguments& arguments, const std::stop_token& stop);
ExitCode Run(const GenerateArguments& arguments, const std::stop_token& stop);
ExitCode Run(const BenchCoreArguments& arguments, const std::stop_token& stop);
ExitCode Run(const BenchServerArguments& arguments, const std::stop_token& stop);
ExitCode Run(const JobsArguments& arguments, const std::stop_token& stop);
ExitCode Run(const WatchArguments& arguments, const std::stop_token& stop);
ExitCode Run(const CancelArguments& arguments, const std::stop_token& stop);
ExitCode Run(const DeleteArguments& arguments, const std::stop_token& stop);
ExitCode Run(const FetchArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ProbeArguments& arguments, const std::stop_token& stop);
ExitCode Run(const TopArguments& arguments, const std::stop_token& stop);

// Skeletonize() by others than the threads of this process.
using ComputeSkeleton = std::function<absl::StatusOr<SkeletonizeResult>(
    const Volume& object, const SkeletonizeOptions& options, const exec::Context& context)>;
// `skeletonize` on this machine, where `compute` does what lies between reading and writing.
ExitCode RunBy(const ComputeSkeleton& compute, const SkeletonizeArguments& arguments,
               const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_COMMANDS_H_
