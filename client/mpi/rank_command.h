#ifndef BCCSKEL_CLIENT_MPI_RANK_COMMAND_H_
#define BCCSKEL_CLIENT_MPI_RANK_COMMAND_H_

#include <stop_token>
#include <variant>

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/cli/console.h"
#include "client/mpi/rank_options.h"
#include "core/ranks/exchange.h"

namespace bccskel::cli {

// The arguments of `skeletonize`, with one thread by default. The same on all ranks.
// Errors: INVALID_ARGUMENT for other commands and for options that ranks do not have.
absl::StatusOr<SkeletonizeArguments> RankArguments(Arguments arguments);

// Runs the command as one rank of the job. Each rank reads its part of the input; rank 0 writes and
// reports.
ExitCode RunRank(SkeletonizeArguments arguments, const RankOptions& options,
                 ranks::Exchange& exchange, const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_MPI_RANK_COMMAND_H_
