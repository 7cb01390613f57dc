#include "core/pruning/sheet_burning.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "core/exec/stop_poll.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

constexpr double kSpeed = 0.8;  // of a ball's surface against the fire
constexpr double kDetour = 1;   // what is later by this came by another way

// The earliest first, of equally early ones in lattice order.
using Turn = std::pair<double, LatticePoint>;
using Turns = std::priority_queue<Turn, std::vector<Turn>, std::greater<>>;

bool MayGo(const ThinSet& set, LatticePoint p) { return IsSimple(set.NeighborsOf(p)); }

}  // namespace

SheetBurning::SheetBurning(const ThinSet& sheets, const PointSet& keep,
                           const exec::Context& context)
    : sheets_(sheets), rest_(sheets) {
  Burn(keep, context);
  Rate();
}

double SheetBurning::ArrivalFrom(LatticePoint origin, LatticePoint p) const {
  return sheets_.RadiusOf(origin) + kSpeed * sheets_.Between(origin, p);
}

void SheetBurning::Burn(const PointSet& keep, const exec::Context& context) {
  StopPoll poll(context);
  Turns turns;
  sheets_.ForEachPoint([&](LatticePoint p) {
    const double radius = sheets_.RadiusOf(p);
    const bool simple = MayGo(sheets_, p);
    fires_.Set(p, {.origin = p, .arrival = radius, .time = radius, .waits = simple});
    if (simple && !keep.contains(p)) turns.emplace(radius, p);
  });
  while (!turns.empty() && !poll.Stopped()) {
    const double time = turns.top().first;
    const LatticePoint p = turns.top().second;
    turns.pop();
    Fire& fire = *fires_.Find(p);
    if (fire.is_out || time != fire.time || !MayGo(rest_, p)) continue;
    fire.is_out = true;
    burned_.push_back(p);
    const LatticePoint origin = fire.origin;
    const NeighborMask neighbors = rest_.NeighborsOf(p);
    rest_.Remove(p);
    ForEachNeighbor(p, neighbors, [&](LatticePoint q) {
      if (keep.contains(q)) return;
      Fire& next = *fires_.Find(q);
      const bool waited = next.waits;
      next.waits = MayGo(rest_, q);
      const double arrival = ArrivalFrom(origin, q);
      const double radius = sheets_.RadiusOf(q);
      if (!waited || arrival < next.arrival) {
        next.arrival = std::max(arrival, radius);
        next.origin = arrival <= radius ? q : origin;
      }
      if (!next.waits) return;
      if (!waited) next.exposed = time;
      next.time = std::max(time, next.arrival);
      turns.emplace(next.time, q);
    });
  }
}

// From the last to the first: whom a fire reached through a point burned later.
void SheetBurning::Rate() {
  const auto hand_on = [&](LatticePoint p) {
    const Fire fire = *fires_.Find(p);
    if (fire.origin == p) return;
    ForEachNeighbor(p, sheets_.NeighborsOf(p), [&](LatticePoint q) {
      Fire& before = *fires_.Find(q);
      const bool earlier = before.is_out && (!fire.is_out || before.time < fire.time) &&
                           before.time >= fire.exposed - kDetour;
      if (!earlier || ArrivalFrom(before.origin, p) > fire.arrival + kDetour) return;
      before.worth = std::max(before.worth, fire.worth);
    });
  };
  sheets_.ForEachPoint([&](LatticePoint p) {
    Fire& fire = *fires_.Find(p);
    fire.worth = fire.arrival - sheets_.RadiusOf(p);
  });
  // What does not burn was reached, too. The most of several is the same in any order.
  rest_.ForEachPoint([&](LatticePoint p) {
    if (fires_.Find(p)->waits || fires_.Find(p)->origin != p) hand_on(p);
  });
  for (auto p = burned_.rbegin(); p != burned_.rend(); ++p) hand_on(*p);
}

}  // namespace bccskel
