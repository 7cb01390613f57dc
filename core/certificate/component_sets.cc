#include "core/certificate/component_sets.h"

#include <vector>

#include "core/certificate/brick_sum.h"
#include "core/certificate/component_links.h"

namespace bccskel {
namespace {

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
