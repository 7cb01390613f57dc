#ifndef BCCSKEL_CLIENT_MPI_RANK_OPTIONS_H_
#define BCCSKEL_CLIENT_MPI_RANK_OPTIONS_H_

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/shapes/shapes.h"
#include "core/ranks/checkpoints.h"

namespace bccskel::cli {

enum class ExchangeReport { kNo, kYes };

// What bccskel-mpi knows besides the options of `bccskel skeletonize`.
struct RankOptions {
  ExchangeReport report = ExchangeReport::kNo;
  std::string checkpoint_folder;  // empty: none
  std::chrono::milliseconds checkpoint_interval = std::chrono::minutes(10);
  ranks::Resuming resuming = ranks::Resuming::kNever;
  std::optional<Shape> shape;  // that the ranks make in place of reading an input
  ShapeOptions shape_options;  // with the points of `--points`
};

inline constexpr char kRankOptionsHelp[] =
    "Options of bccskel-mpi besides:\n"
    "  --checkpoint FOLDER         Write what is left of the object there between shells; all "
    "ranks "
    "must see the folder\n"
    "  --checkpoint-every SECONDS  How often (default 600); 0: after each shell\n"
    "  --resume                    Go on from the checkpoint in the folder, on any number of "
    "ranks; "
    "without one begin anew\n"
    "  --generate SHAPE            Make a shape of `bccskel generate` instead of reading INPUT, "
    "with "
    "--points,\n"
    "  --seed N, --noise X         as there\n"
    "  --report-exchange           Tell on standard error what each rank sent, and its memory\n";

// Takes those options out of the words of a command line.
// Errors: INVALID_ARGUMENT.
absl::StatusOr<RankOptions> TakeRankOptions(std::vector<char*>& words);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_MPI_RANK_OPTIONS_H_
