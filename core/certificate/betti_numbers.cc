// Does: components by labeling the object, cavities by labeling the background, loops from the
//       Euler characteristic: b0 - b1 + b2 = chi.
// Why it is right: on the bcc grid object and background use the same neighborhood N14, and three
//       mutually adjacent points never leave a gap, so the background components other than the
//       outer one are the cavities.
// Cost: per brick the planes for chi, one connectivity test and a few look-ups in the disjoint
// sets;
//       labels of points only in bricks that hold several components. Bricks inside the object have
//       no background.
#include <vector>

#include "core/certificate/background_gaps.h"
#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/certificate/component_links.h"
#include "core/certificate/phase_components.h"
#include "core/certificate/union_find.h"

namespace bccskel {
namespace {

int64_t LinkBricks(const Volume& object, ComponentLinks& links, const exec::Context& context) {
  std::vector<GapPlaces> places(static_cast<size_t>(context.threads()));
  return SumOverBricks(context, object.brick_count(), [&](int worker, exec::Share batch) {
    int64_t joined = 0;
    for (size_t n = batch.begin; n < batch.end; ++n) {
      joined += links.LinkBrick(static_cast<BrickIndex>(n), places[static_cast<size_t>(worker)]);
    }
    return joined;
  });
}

int64_t CountObjectComponents(const Volume& object, const exec::Context& context) {
  const PhaseComponents pieces(object, Phase::kObject, context);
  UnionFind sets(pieces.number_limit());
  ComponentLinks links(object, pieces, nullptr, sets);
  return pieces.count() - LinkBricks(object, links, context);
}

// Node g of the gaps is member first_member + g of the sets.
int64_t LinkGaps(const BackgroundGaps& gaps, size_t first_member, UnionFind& sets,
                 const exec::Context& context) {
  std::vector<GapPlaces> places(static_cast<size_t>(context.threads()));
  return SumOverBricks(context, gaps.place_count(), [&](int worker, exec::Share batch) {
    int64_t joined = 0;
    for (size_t place = batch.begin; place < batch.end; ++place) {
      joined += gaps.LinkGap(place, first_member, places[static_cast<size_t>(worker)], sets);
    }
    return joined;
  });
}

// The outside is one of them.
int64_t CountBackgroundComponents(const Volume& object, const exec::Context& context) {
  const PhaseComponents pieces(object, Phase::kBackground, context);
  const BackgroundGaps gaps(object.keys());
  UnionFind sets(pieces.number_limit() + gaps.node_limit());
  const int64_t joined = LinkGaps(gaps, pieces.number_limit(), sets, context);
  ComponentLinks links(object, pieces, &gaps, sets);
  return pieces.count() + gaps.node_count() - joined - LinkBricks(object, links, context);
}

}  // namespace

absl::StatusOr<BettiNumbers> CountBettiNumbers(const Volume& object, const exec::Context& context) {
  BettiNumbers betti;
  betti.components = CountObjectComponents(object, context);
  betti.cavities = CountBackgroundComponents(object, context) - 1;
  betti.loops = betti.components + betti.cavities - CountEulerCharacteristic(object, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return betti;
}

}  // namespace bccskel
