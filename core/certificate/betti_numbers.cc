// Does:  components by labeling the object, cavities by labeling the background, loops from the
//        Euler characteristic: b0 - b1 + b2 = chi.
// Why it is right: on the bcc grid object and background use the same neighborhood N14, and three
//   mutually adjacent points never leave a gap, so the background components other than the outer
//   one are the cavities.
// Cost:  per brick the planes for chi, one connectivity test and a few look-ups in the disjoint
//        sets; labels of points only in bricks that hold several components. Bricks inside the
//        object have no background.
#include "core/certificate/certificate.h"
#include "core/certificate/component_sets.h"

namespace bccskel {

absl::StatusOr<BettiNumbers> CountBettiNumbers(const Volume& object, const exec::Context& context) {
  BettiNumbers betti;
  betti.components = ComponentSets(object, Phase::kObject, context).count();
  betti.cavities = ComponentSets(object, Phase::kBackground, context).count() - 1;
  betti.loops = betti.components + betti.cavities - CountEulerCharacteristic(object, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return betti;
}

}  // namespace bccskel
