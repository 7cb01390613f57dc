#include "core/certificate/component_sets.h"

#include <array>
#include <bit>
#include <span>
#include <vector>

#include "core/certificate/brick_contacts.h"
#include "core/certificate/brick_sum.h"
#include "core/certificate/neighbor_planes.h"
#include "core/lattice/directions.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

constexpr bool IsDownward(Direction d) { return d.offset().x + d.offset().y + d.offset().z < 0; }

// Each pair of neighboring bricks is processed from one side: even from odd, + from -.
constexpr PositionMask ComputeLinkedFrom(Sublattice sublattice) {
  PositionMask linked = sublattice == Sublattice::kEven ? 0xff : 0;
  for (int position = 8; position < kNeighborCount; ++position) {
    linked |= (IsDownward(Direction(position)) ? 1u : 0u) << position;
  }
  return linked;
}
constexpr std::array<PositionMask, 2> kLinkedFrom = {ComputeLinkedFrom(Sublattice::kEven),
                                                     ComputeLinkedFrom(Sublattice::kOdd)};

// The points of a set without a predecessor along x, y or z: at least one of each connected part.
BrickBits FirstOfParts(const BrickBits& points) {
  constexpr uint64_t kFirstOfRows = 0x0001000100010001;
  BrickBits first;
  for (size_t k = 0; k < 8; ++k) {
    const uint64_t word = points.words[k], below = k > 0 ? points.words[k - 1] : 0;
    first.words[k] = word & ~((word << 1 & ~kFirstOfRows) | word << 16 | below);
  }
  return first;
}

template <typename Visit>
void ForEachPosition(PositionMask positions, Visit visit) {
  for (; positions != 0; positions &= positions - 1) visit(std::countr_zero(positions));
}

// The positions of `among` that are connected with `position`, including itself.
PositionMask GroupOf(int position, PositionMask among, Sublattice sublattice) {
  const BrickContacts& contacts = ContactsOf(sublattice);
  PositionMask group = 0;
  for (PositionMask fresh = 1u << position; fresh != 0;) {
    group |= fresh;
    PositionMask reached = 0;
    ForEachPosition(fresh, [&](int at) { reached |= contacts.beside[static_cast<size_t>(at)]; });
    fresh = reached & among & ~group;
  }
  return group;
}

// Unites the components of neighboring bricks that touch.
// Threads: any number may link different bricks at the same time.
class ComponentLinks {
 public:
  // Component c of `components` is member c of `sets`; node g of `gaps`, which is null for the
  // object, is member components.number_limit() + g.
  ComponentLinks(const Volume& object, const PhaseComponents& components,
                 const BackgroundGaps* gaps, UnionFind<size_t>& sets)
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
  UnionFind<size_t>& sets_;
};

int64_t ComponentLinks::LinkBrick(BrickIndex n, GapPlaces& places) {
  if (!components_.HasPoints(n)) return 0;
  const BricksAround around = LookAround(n);
  const PositionMask missing =
      gaps_ == nullptr || around.missing == 0 ? 0 : around.missing & KnownAround(n);
  const PositionMask open = missing | around.in_other_sets;
  int64_t joined = 0;
  if (open != 0) {
    const PositionMask touched =
        open & FindTouchedBricks(SublatticeAt(n), components_.mains(), n, neighbors_[n]);
    joined += LinkMains(n, touched & around.in_other_sets);
    joined += LinkMainToGaps(n, touched & missing, missing, places);
  }
  if (components_.fragments(n) == nullptr) return joined;
  joined += LinkFragments(n);
  ForEachPosition(missing,
                  [&](int position) { joined += LinkFragmentsToGap(n, position, places); });
  return joined;
}

// Most adjacent bricks are in the same set already, through bricks linked before, and most of those
// directly below the root of the set.
ComponentLinks::BricksAround ComponentLinks::LookAround(BrickIndex n) {
  const size_t root = sets_.Find(n), stored = object_.brick_count();
  BricksAround around = {0, 0};
  for (int position = 0; position < kNeighborCount; ++position) {
    const BrickIndex other = NeighborAt(n, position);
    around.missing |= (other < stored ? 0u : 1u) << position;
    around.in_other_sets |= (sets_.IsRightBelow(other, root) ? 0u : 1u) << position;
  }
  around.in_other_sets &= kLinkedFrom[static_cast<size_t>(SublatticeAt(n))] & ~around.missing;
  ForEachPosition(around.in_other_sets, [&](int position) {
    const BrickIndex other = NeighborAt(n, position);
    if (components_.HasPoints(other) && sets_.Find(other) != root) return;
    around.in_other_sets &= ~(1u << position);
  });
  return around;
}

// The positions in known layers.
PositionMask ComponentLinks::KnownAround(BrickIndex n) const {
  const BrickCoordinates brick = object_.keys()[n].coordinates();
  PositionMask known = ~PositionMask{0};
  if (gaps_->known().Has(brick.bz - 1) && gaps_->known().Has(brick.bz + 1)) return known;
  for (int position = 0; position < kNeighborCount; ++position) {
    if (gaps_->known().Has(NeighborBrick(brick, position).bz)) continue;
    known &= ~(PositionMask{1} << position);
  }
  return known;
}

int64_t ComponentLinks::LinkMains(BrickIndex n, PositionMask touched) {
  int64_t joined = 0;
  ForEachPosition(touched, [&](int position) { joined += Unite(n, NeighborAt(n, position)); });
  return joined;
}

// Bricks that are not stored are all background, and gaps that touch each other are linked: one of
// each group is enough.
int64_t ComponentLinks::LinkMainToGaps(BrickIndex n, PositionMask touched, PositionMask missing,
                                       GapPlaces& places) {
  int64_t joined = 0;
  while (touched != 0) {
    const int position = std::countr_zero(touched);
    joined += Unite(n, GapAt(n, position, places));
    touched &= ~GroupOf(position, missing, SublatticeAt(n));
  }
  return joined;
}

size_t ComponentLinks::GapAt(BrickIndex n, int position, GapPlaces& places) const {
  const BrickCoordinates brick = object_.keys()[n].coordinates();
  return components_.number_limit() +
         gaps_->NodeAt(NeighborBrick(brick, position), places.of(brick, position));
}

// Links fragments to all components that they touch in other bricks.
int64_t ComponentLinks::LinkFragments(BrickIndex n) {
  BrickSurroundings bricks{components_.PointsOf(n), {}};
  for (size_t position = 0; position < kNeighborCount; ++position) {
    const BrickIndex other = neighbors_[n][position];
    if (IsStored(other)) bricks.around[position] = components_.PointsOf(other);
  }
  const NeighborPlanes planes = FindNeighborPlanes(SublatticeAt(n), bricks);
  int64_t joined = 0;
  for (int d = 0; d < kNeighborCount; ++d) {
    joined += LinkFragmentsAlong(n, Direction(d), planes[static_cast<size_t>(d)]);
  }
  return joined;
}

// Adjacent points whose neighbors are in one other brick link the same two components.
int64_t ComponentLinks::LinkFragmentsAlong(BrickIndex n, Direction d,
                                           const BrickBits& having_neighbor) {
  const Sublattice sublattice = SublatticeAt(n);
  const BrickBits points = components_.fragments(n)->fragments & having_neighbor;
  if (points.Empty()) return 0;
  int64_t joined = 0;
  for (const BrickContact& contact : ContactsOf(sublattice).along[static_cast<size_t>(d.bit())]) {
    const BrickBits leaving = points & contact.points;
    if (leaving.Empty()) continue;
    const BrickIndex other = NeighborAt(n, contact.position);
    FirstOfParts(leaving).ForEachSetBit([&](int bit) {
      joined += Unite(components_.NumberOf(n, bit),
                      components_.NumberOf(other, NeighborBit(sublattice, d, bit)));
    });
  }
  return joined;
}

int64_t ComponentLinks::LinkFragmentsToGap(BrickIndex n, int position, GapPlaces& places) {
  const BrickBits& contact = ContactsOf(SublatticeAt(n)).points_at[static_cast<size_t>(position)];
  const BrickBits touching = components_.fragments(n)->fragments & contact;
  if (touching.Empty()) return 0;
  const size_t gap = GapAt(n, position, places);
  int64_t joined = 0;
  FirstOfParts(touching).ForEachSetBit(
      [&](int bit) { joined += Unite(components_.NumberOf(n, bit), gap); });
  return joined;
}

std::optional<BackgroundGaps> GapsOf(const Volume& object, Phase phase, const KnownLayers& known) {
  if (phase == Phase::kObject) return std::nullopt;
  return BackgroundGaps(object.keys(), known);
}

}  // namespace

ComponentSets::ComponentSets(const Volume& object, Phase phase, const exec::Context& context,
                             const KnownLayers& known)
    : pieces_(object, phase, context),
      gaps_(GapsOf(object, phase, known)),
      sets_(pieces_.number_limit() + (gaps_.has_value() ? gaps_->node_limit() : 0)) {
  count_ = pieces_.count();
  if (gaps_.has_value()) count_ += gaps_->node_count() - LinkGaps(context);
  count_ -= LinkBricks(object, context);
}

int64_t ComponentSets::LinkGaps(const exec::Context& context) {
  std::vector<GapPlaces> places(static_cast<size_t>(context.threads()));
  return SumOverBricks(context, gaps_->place_count(), [&](int worker, exec::Share batch) {
    int64_t joined = 0;
    for (size_t place = batch.begin; place < batch.end; ++place) {
      joined +=
          gaps_->LinkGap(place, pieces_.number_limit(), places[static_cast<size_t>(worker)], sets_);
    }
    return joined;
  });
}

int64_t ComponentSets::LinkBricks(const Volume& object, const exec::Context& context) {
  ComponentLinks links(object, pieces_, gaps_.has_value() ? &*gaps_ : nullptr, sets_);
  std::vector<GapPlaces> places(static_cast<size_t>(context.threads()));
  return SumOverBricks(context, object.brick_count(), [&](int worker, exec::Share batch) {
    int64_t joined = 0;
    for (size_t n = batch.begin; n < batch.end; ++n) {
      joined += links.LinkBrick(static_cast<BrickIndex>(n), places[static_cast<size_t>(worker)]);
    }
    return joined;
  });
}

}  // namespace bccskel
