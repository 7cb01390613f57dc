#ifndef BCCSKEL_CORE_CERTIFICATE_PHASE_COMPONENTS_H_
#define BCCSKEL_CORE_CERTIFICATE_PHASE_COMPONENTS_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/certificate/brick_components.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// The components of an object, or of its background, within each stored brick: the pieces that
// component labeling joins. Nearly all bricks have one or none; only the others store labels.
class PhaseComponents {
 public:
  PhaseComponents(const Volume& object, Phase phase, const exec::Context& context);

  int64_t count() const { return count_; }
  bool HasPoints(BrickIndex n) const { return connectivity_[n] != Connectivity::kEmpty; }
  const BrickFragments* fragments(BrickIndex n) const { return fragments_[n]; }  // may be null

  // Numbers of components are below number_limit(); some are unused. The main component of a brick
  // has the number of the brick.
  size_t number_limit() const { return number_limit_; }
  // Needs: `bit` is a point of this phase.
  size_t NumberOf(BrickIndex n, int bit) const {
    const BrickFragments* split = fragments_[n];
    const size_t label = split == nullptr ? 0 : split->labels[static_cast<size_t>(bit)];
    return label == 0 ? n : split->first_number + label - 1;
  }

  // The points of each brick's main component, and a padding brick for bricks that are not stored,
  // which is all background.
  std::span<const BrickBits> mains() const { return mains_; }
  BrickBits PointsOf(BrickIndex n) const {
    return fragments_[n] == nullptr ? mains_[n] : mains_[n] | fragments_[n]->fragments;
  }

 private:
  int64_t CountComponents(int worker, BrickIndex n);
  void NumberFragments();

  int64_t count_ = 0;
  size_t number_limit_ = 0;
  std::vector<Connectivity> connectivity_;
  std::vector<BrickBits> mains_;
  std::vector<const BrickFragments*> fragments_;   // one more, for the padding brick
  std::vector<std::deque<BrickFragments>> store_;  // one per worker
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_PHASE_COMPONENTS_H_
