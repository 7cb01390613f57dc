#ifndef BCCSKEL_CORE_CERTIFICATE_COMPONENT_LINKS_H_
#define BCCSKEL_CORE_CERTIFICATE_COMPONENT_LINKS_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/certificate/background_gaps.h"
#include "core/certificate/neighbor_planes.h"
#include "core/certificate/phase_components.h"
#include "core/certificate/union_find.h"
#include "core/lattice/directions.h"
#include "core/volume/brick_neighbors.h"
#include "core/volume/volume.h"

namespace bccskel {

// Unites the components of neighboring bricks that touch.
// Threads: any number may link different bricks at the same time.
class ComponentLinks {
 public:
  // Component c of `components` is member c of `sets`; node g of `gaps`, which is null for the
  // object, is member components.number_limit() + g.
  ComponentLinks(const Volume& object, const PhaseComponents& components,
                 const BackgroundGaps* gaps, UnionFind& sets)
      : object_(object),
        neighbors_(object.neighbors()),
        components_(components),
        gaps_(gaps),
        sets_(sets) {}

  // Links brick n to every stored brick that touches it, each pair of bricks from one side only,
  // and to all gaps. `places` belongs to the calling thread. Returns how many sets it joined.
  int64_t LinkBrick(BrickIndex n, GapPlaces& places);

 private:
  struct BricksAround {
    PositionMask missing;
    PositionMask in_other_sets;  // stored, to be linked from here, main component in another set
  };
  BricksAround LookAround(BrickIndex n);
  PositionMask KnownAround(BrickIndex n) const;
  int64_t LinkMains(BrickIndex n, PositionMask touched);
  int64_t LinkMainToGaps(BrickIndex n, PositionMask touched, PositionMask missing,
                         GapPlaces& places);
  int64_t LinkFragments(BrickIndex n);
  int64_t LinkFragmentsAlong(BrickIndex n, Direction d, const BrickBits& having_neighbor);
  int64_t LinkFragmentsToGap(BrickIndex n, int position, GapPlaces& places);
  size_t GapAt(BrickIndex n, int position, GapPlaces& places) const;
  int64_t Unite(size_t a, size_t b) { return sets_.Unite(a, b) ? 1 : 0; }
  Sublattice SublatticeAt(BrickIndex n) const { return object_.keys()[n].sublattice(); }
  BrickIndex NeighborAt(BrickIndex n, int position) const {
    return neighbors_[n][static_cast<size_t>(position)];
  }
  bool IsStored(BrickIndex n) const { return n < object_.brick_count(); }

  const Volume& object_;
  const std::span<const BrickNeighborhood> neighbors_;
  const PhaseComponents& components_;
  const BackgroundGaps* const gaps_;
  UnionFind& sets_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_COMPONENT_LINKS_H_
