// Does: components by labeling the object, cavities by labeling the background, loops from the
// Euler
//       characteristic: b0 - b1 + b2 = chi.
// Why it is right: on the bcc grid object and background use the same neighborhood N14, and three
//       mutually adjacent points never leave a gap, so the background components other than the
//       outer one are the cavities.
// Cost: per brick 7 neighbor planes for chi and at most 7 for each labeling; labels of points only
// in
//       bricks that hold several components. Bricks inside the object cost next to nothing.
#include <vector>

#include "core/certificate/background_gaps.h"
#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/certificate/component_links.h"
#include "core/certificate/euler_characteristic.h"
#include "core/certificate/phase_components.h"
#include "core/certificate/union_find.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

int64_t LinkBricks(const Volume& object, ComponentLinks& links, const exec::Context& context) {
  std::vector<GapPlaces> places(static_cast<size_t>(context.threads()));
  return SumOverBricks(context, object.brick_count(), [&](int worker, size_t n) {
    return links.LinkBrick(static_cast<BrickIndex>(n), places[static_cast<size_t>(worker)]);
  });
}

int64_t CountObjectComponents(const Volume& object, std::span<const BrickNeighborhood> neighbors,
                              const exec::Context& context) {
  const PhaseComponents pieces(object, Phase::kObject, context);
  UnionFind sets(pieces.count());
  ComponentLinks links(object, neighbors, pieces, nullptr, sets);
  return static_cast<int64_t>(pieces.count()) - LinkBricks(object, links, context);
}

// The outside is one of them.
int64_t CountBackgroundComponents(const Volume& object,
                                  std::span<const BrickNeighborhood> neighbors,
                                  const exec::Context& context) {
  const PhaseComponents pieces(object, Phase::kBackground, context);
  const BackgroundGaps gaps(object.keys());
  UnionFind sets(gaps.node_limit() + pieces.count());
  const int64_t joined = SumOverBricks(
      context, gaps.place_count(), [&](int, size_t place) { return gaps.LinkGap(place, sets); });
  ComponentLinks links(object, neighbors, pieces, &gaps, sets);
  return static_cast<int64_t>(pieces.count()) + gaps.node_count() - joined -
         LinkBricks(object, links, context);
}

}  // namespace

absl::StatusOr<BettiNumbers> CountBettiNumbers(const Volume& object, const exec::Context& context) {
  const std::vector<BrickNeighborhood> neighbors = FindBrickNeighbors(object.keys());
  BettiNumbers betti;
  betti.components = CountObjectComponents(object, neighbors, context);
  betti.cavities = CountBackgroundComponents(object, neighbors, context) - 1;
  betti.loops =
      betti.components + betti.cavities - CountEulerCharacteristic(object, neighbors, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return betti;
}

}  // namespace bccskel
