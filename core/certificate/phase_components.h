#ifndef BCCSKEL_CORE_CERTIFICATE_PHASE_COMPONENTS_H_
#define BCCSKEL_CORE_CERTIFICATE_PHASE_COMPONENTS_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/certificate/brick_components.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

enum class Phase : uint8_t { kObject, kBackground };

// The components of each stored brick of an object, or of the background within each stored brick,
// numbered through: the pieces that component labeling puts together. Nearly all bricks have one or
// none; only the others keep labels.
class PhaseComponents {
 public:
  PhaseComponents(const Volume& object, Phase phase, const exec::Context& context);

  size_t count() const { return first_.back(); }
  bool HasPoints(BrickIndex n) const { return first_[n] != first_[n + 1]; }
  const BrickFragments* fragments(BrickIndex n) const { return fragments_[n]; }  // may be null

  // Needs: HasPoints(n).
  size_t MainComponent(BrickIndex n) const { return first_[n]; }
  // Needs: `bit` is a point of this phase.
  size_t ComponentOf(BrickIndex n, int bit) const {
    return first_[n] +
           (fragments_[n] == nullptr ? 0 : fragments_[n]->labels[static_cast<size_t>(bit)]);
  }

  // The points of the brick, those of its main component, those outside of it. The padding brick
  // has no points: bricks that are not stored are not this class's business.
  BrickBits PointsOf(BrickIndex n) const;
  BrickBits MainPointsOf(BrickIndex n) const;
  BrickBits FragmentPointsOf(BrickIndex n) const;

 private:
  int64_t SplitIntoComponents(int worker, BrickIndex n);

  const Volume& object_;
  const uint64_t flip_;  // all ones for the background
  std::vector<size_t> first_;
  std::vector<const BrickFragments*> fragments_;   // one more, for the padding brick
  std::vector<std::deque<BrickFragments>> store_;  // one per worker
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_PHASE_COMPONENTS_H_
