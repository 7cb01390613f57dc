#ifndef BCCSKEL_CORE_PRUNING_LAST_LIMB_H_
#define BCCSKEL_CORE_PRUNING_LAST_LIMB_H_

#include <cstddef>
#include <optional>
#include <span>

#include "core/pruning/ball_index.h"
#include "core/pruning/significance.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Finds the last limb of a branch behind a bead: a part at least 1.4 times as thick as the limb
// after it, from which the limb would stay as a branch of its own.
// Needs:   `object` outlives this; `noise` is that of its surface.
// Threads: one thread per instance.
class LastLimb {
 public:
  LastLimb(const Volume& object, const SurfaceNoise& noise, const BallIndex& balls)
      : object_(object), noise_(noise), balls_(balls) {}
  // Forgets what was measured of earlier paths.
  void Forget() {
    if (significance_.has_value()) significance_->Forget();
  }

  // Position of the limb's first point; `first` if there is no bead. Needs: a path of curve points
  // of `set` whose last point is an end; `first` is a position in it.
  size_t BeginIn(const ThinSet& set, std::span<const LatticePoint> path, size_t first);

  // The significance of the path as a branch that begins at its first point. Needs: as above; at
  // least two points.
  double SignificanceOf(const ThinSet& set, std::span<const LatticePoint> path);

 private:
  bool SticksOut(const ThinSet& set, LatticePoint root, LatticePoint tip) const;
  const Volume& object_;
  const SurfaceNoise noise_;
  const BallIndex balls_;
  std::optional<Significance> significance_;  // created on first use
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_LAST_LIMB_H_
