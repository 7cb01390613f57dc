#ifndef BCCSKEL_CORE_THINNING_PEELED_POINTS_H_
#define BCCSKEL_CORE_THINNING_PEELED_POINTS_H_

#include <span>
#include <utility>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Finds the points of an object that were removed since the last call.
class PeeledPoints {
 public:
  // `object` must outlive this.
  explicit PeeledPoints(const Volume& object)
      : object_(object), before_(object.bricks().begin(), object.bricks().end()) {}

  // Shapes: `now` in the brick order of the object, padded or not; a subset of the previous one.
  Volume Take(std::span<const BrickBits> now) {
    std::vector<BrickKey> keys;
    std::vector<BrickBits> gone;
    for (size_t n = 0; n < before_.size(); ++n) {
      if (before_[n] == now[n]) continue;
      keys.push_back(object_.keys()[n]);
      gone.push_back(before_[n] & ~now[n]);
      before_[n] = now[n];
    }
    return Volume::FromSortedBricks(object_.extent(), object_.placement(), std::move(keys),
                                    std::move(gone));
  }

 private:
  const Volume& object_;
  std::vector<BrickBits> before_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_PEELED_POINTS_H_
