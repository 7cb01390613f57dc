#ifndef BCCSKEL_CORE_RANKS_CHECKPOINTS_H_
#define BCCSKEL_CORE_RANKS_CHECKPOINTS_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/ranks/exchange.h"
#include "core/ranks/rank_bricks.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel::ranks {

// A folder that all ranks can access. Threads: one thread of each rank.
class CheckpointFolder {
 public:
  virtual ~CheckpointFolder() = default;

  // Atomic and durable: the file survives a power failure.
  virtual absl::Status Write(const std::string& name, const Bytes& bytes) = 0;
  // Errors: NOT_FOUND.
  virtual absl::StatusOr<Bytes> Read(const std::string& name) = 0;
  virtual void Remove(const std::string& name) = 0;
};

enum class Resuming : uint8_t {
  kNever,     // starts from the beginning; the first checkpoint replaces an old one
  kWhereDone  // continues from the checkpoint, or from the beginning if there is none
};

struct CheckpointOptions {
  CheckpointFolder* folder = nullptr;  // null: none
  Resuming resuming = Resuming::kNever;
  std::chrono::milliseconds interval = std::chrono::minutes(10);  // 0: after each shell
};

// What remains of an object after some shells.
struct ShellsDone {
  int32_t shells = 0;
  std::vector<IsthmusBirth> isthmuses;  // of all ranks
};

// Writes what remains of the object between shells, each rank its own bricks, and reads it back on
// any number of ranks. A checkpoint becomes valid when rank 0 writes the file that names it, after
// all ranks have written their parts; then the previous checkpoint is deleted.
class Checkpoints {
 public:
  // Called by all ranks together. `bricks` and `exchange` outlive this.
  Checkpoints(Exchange& exchange, const RankBricks& bricks, const CheckpointOptions& options,
              DistanceKind distance, const ThinningOptions& thinning);

  // Stores the bricks of the last checkpoint in `object`, in the order of bricks.local; returns 0
  // shells and leaves `object` empty if there is no checkpoint or none is wanted.
  // Errors: FAILED_PRECONDITION (checkpoint of another object or of other options, or damaged); on
  //         all ranks.
  absl::StatusOr<ShellsDone> Resume(std::vector<BrickBits>& object);

  // Writes a checkpoint if the interval has passed. Called by all ranks together, after a shell.
  // Errors: of the folder; on all ranks.
  absl::Status AfterShell(int32_t shell, const ThinningState& state,
                          const std::vector<IsthmusBirth>& isthmuses);

  bool wanted() const { return options_.folder != nullptr; }

 private:
  struct Mark {
    int32_t shells = 0;
    int32_t ranks = 0;
    uint64_t job = 0;
  };
  using Clock = std::chrono::steady_clock;

  absl::StatusOr<Mark> ReadMark();
  absl::StatusOr<std::vector<Bytes>> ReadParts(const Mark& mark);
  Bytes PartOf(const ThinningState& state, const std::vector<IsthmusBirth>& isthmuses) const;

  Exchange& exchange_;
  const RankBricks& bricks_;
  const CheckpointOptions options_;
  uint64_t job_ = 0;  // hash of the object and the options
  std::optional<Mark> last_;
  Clock::time_point written_ = Clock::now();
};

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_CHECKPOINTS_H_
