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
    "Further options of bccskel-mpi:\n"
    "  --checkpoint FOLDER         Write what remains of the object to this folder between "
    "shells;\n"
    "                              all ranks need access to it\n"
    "  --checkpoint-every SECONDS  Interval (default 600); 0: after each shell\n"
    "  --resume                    Continue from the checkpoint in the folder, on any number of\n"
    "                              ranks; start from the beginning if there is none\n"
    "  --generate SHAPE            Make a shape of `bccskel generate` instead of reading INPUT;\n"
    "                              also --points N, --seed N, --noise X\n"
    "  --report-exchange           Report on standard error what each rank sent, and its memory\n";

// Takes those options out of the words of a command line.
// Errors: INVALID_ARGUMENT.
absl::StatusOr<RankOptions> TakeRankOptions(std::vector<char*>& words);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_MPI_RANK_OPTIONS_H_
