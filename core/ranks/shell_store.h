#ifndef BCCSKEL_CORE_RANKS_SHELL_STORE_H_
#define BCCSKEL_CORE_RANKS_SHELL_STORE_H_

#include <vector>

#include "core/exec/uninitialized.h"
#include "core/exec/worker_team.h"
#include "core/ranks/exchange.h"
#include "core/ranks/packing.h"
#include "core/ranks/rank_bricks.h"
#include "core/ranks/rank_shells.h"

namespace bccskel::ranks {

// Collects the shells of a rank's bricks from the ranks that measure their distances.
class ShellStore {
 public:
  // Needs: `bricks` and `exchange` outlive this.
  ShellStore(Exchange& exchange, const RankBricks& bricks, double shell_width, Depths depths);

  // Announces the bricks that are measured next: shells of own bricks are stored, those of other
  // ranks' bricks are kept until SendAway().
  void Expect(const Volume& volume, exec::Share measured);
  // The destinations of the shells of these bricks. Needs: this outlives them.
  ShellPlaces Places();
  // Slices squared distances into these shells.
  SquareSlicer Slicer();
  // Sends the shells of other ranks' bricks. Called by all ranks together.
  void SendAway(const Volume& volume);

  // Needs: the shells of all own bricks have arrived.
  RankShells Finish() &&;

 private:
  ShellPlace ShellsOf(BrickIndex brick);
  DepthPlanes& DepthsOf(BrickIndex brick);
  void KeepAll(const std::vector<Bytes>& letters);
  void Keep(Unpacker& from);

  Exchange& exchange_;
  const RankBricks& bricks_;
  const double shell_width_;
  const Depths depths_;
  exec::UninitializedVector<ShellPlanes> planes_;
  std::vector<Shells::Range> ranges_;
  BrickDepths deep_;

  struct Place {
    bool is_own;
    BrickIndex n;  // among the bricks of this rank, or among those to be sent
  };
  size_t first_measured_ = 0;
  std::vector<Place> places_;     // of the measured bricks
  std::vector<BrickIndex> away_;  // measured bricks of others
  exec::UninitializedVector<ShellPlanes> away_planes_;
  std::vector<Shells::Range> away_ranges_;
  BrickDepths away_deep_;
};

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_SHELL_STORE_H_
