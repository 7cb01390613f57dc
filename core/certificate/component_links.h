#ifndef BCCSKEL_CORE_CERTIFICATE_COMPONENT_LINKS_H_
#define BCCSKEL_CORE_CERTIFICATE_COMPONENT_LINKS_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/certificate/background_gaps.h"
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
  // Component c of `components` is member first_member + c of `sets`. `gaps` (null for the object)
  // are members 0..gaps->node_limit()-1.
  ComponentLinks(const Volume& object, std::span<const BrickNeighborhood> neighbors,
                 const PhaseComponents& components, const BackgroundGaps* gaps, UnionFind& sets)
      : object_(object),
        neighbors_(neighbors),
        components_(components),
        gaps_(gaps),
        first_member_(gaps == nullptr ? 0 : gaps->node_limit()),
        sets_(sets) {}

  // Links brick n to every stored brick that touches it, each pair of bricks from one side only,
  // and to all gaps. `places` belongs to the calling thread. Returns how many sets it
  // joined.
  int64_t LinkBrick(BrickIndex n, GapPlaces& places);

 private:
  int64_t LinkMains(BrickIndex n, int position);
  bool HasFragmentsAround(BrickIndex n) const;
  int64_t LinkFragments(BrickIndex n, Direction d);
  int64_t LinkToGap(BrickIndex n, int position, GapPlaces& places);
  int64_t Unite(size_t a, size_t b) { return sets_.Unite(a, b) ? 1 : 0; }
  size_t MemberOf(BrickIndex n, int bit) const {
    return first_member_ + components_.ComponentOf(n, bit);
  }
  size_t MainMember(BrickIndex n) const { return first_member_ + components_.MainComponent(n); }
  Sublattice SublatticeAt(BrickIndex n) const { return object_.keys()[n].coordinates().sublattice; }
  BrickIndex NeighborAt(BrickIndex n, int position) const {
    return neighbors_[n][static_cast<size_t>(position)];
  }
  bool IsStored(BrickIndex n) const { return n < object_.brick_count(); }

  const Volume& object_;
  const std::span<const BrickNeighborhood> neighbors_;
  const PhaseComponents& components_;
  const BackgroundGaps* const gaps_;
  const size_t first_member_;
  UnionFind& sets_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_COMPONENT_LINKS_H_
