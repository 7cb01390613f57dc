#include "core/pruning/sheet_burning.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "core/distance/places.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

constexpr double kSpeed = 0.8;  // time that a fire takes per lattice unit
constexpr double kDetour = 1;   // what arrives later by more than this came another way

// The earliest first, of equally early ones in lattice order.
using Turn = std::pair<double, PointIndex>;
using Turns = std::priority_queue<Turn, std::vector<Turn>, std::greater<>>;

}  // namespace

SheetBurning::SheetBurning(const ThinPoints& points, const AxisScale& scale,
                           std::span<const uint8_t> kept, StopPoll& poll)
    : points_(points), scale_(scale), rest_(points), fires_(points.size()) {
  Burn(kept, poll);
  Rate();
}

double SheetBurning::ArrivalFrom(PointIndex origin, PointIndex p) const {
  const SkeletonPoint& from = points_[origin];
  return from.radius + kSpeed * StraightDistance(from.point, points_[p].point, scale_);
}

void SheetBurning::Burn(std::span<const uint8_t> kept, StopPoll& poll) {
  Turns turns;
  for (PointIndex p = 0; p < points_.size(); ++p) {
    const double radius = points_[p].radius;
    const bool simple = IsSimple(points_.mask(p));
    fires_[p] = {.origin = p, .waits = simple, .arrival = radius, .time = radius};
    if (simple && kept[p] == 0) turns.emplace(radius, p);
  }
  while (!turns.empty() && !poll.Stopped()) {
    const double time = turns.top().first;
    const PointIndex p = turns.top().second;
    turns.pop();
    Fire& fire = fires_[p];
    if (fire.is_out || time != fire.time || !fire.waits) continue;
    fire.is_out = true;
    burned_.push_back(p);
    const PointIndex origin = fire.origin;
    const NeighborMask neighbors = rest_.mask(p);
    rest_.Remove(p);
    ForEachDirection(neighbors, [&](Direction d) {
      const PointIndex q = points_.Neighbor(p, d);
      if (kept[q] != 0) return;
      Fire& next = fires_[q];
      const bool waited = next.waits;
      const double arrival = ArrivalFrom(origin, q);
      const double radius = points_[q].radius;
      next.waits = IsSimple(rest_.mask(q));
      if (!waited || arrival < next.arrival) {
        next.arrival = std::max(arrival, radius);
        next.origin = arrival <= radius ? q : origin;
      }
      if (!next.waits) return;
      if (!waited) next.exposed = time;
      const double before = next.time;
      next.time = std::max(time, next.arrival);
      if (!waited || next.time != before) turns.emplace(next.time, q);
    });
  }
}

// From last to first, since points that a fire reached through another point burned later.
void SheetBurning::Rate() {
  const auto hand_on = [&](PointIndex p) {
    const Fire& fire = fires_[p];
    if (fire.origin == p) return;
    ForEachDirection(points_.mask(p), [&](Direction d) {
      Fire& before = fires_[points_.Neighbor(p, d)];
      const bool earlier = before.is_out && (!fire.is_out || before.time < fire.time) &&
                           before.time >= fire.exposed - kDetour;
      if (!earlier || ArrivalFrom(before.origin, p) > fire.arrival + kDetour) return;
      before.worth = std::max(before.worth, fire.worth);
    });
  };
  for (PointIndex p = 0; p < points_.size(); ++p) {
    fires_[p].worth = fires_[p].arrival - points_[p].radius;
  }
  // Points that do not burn were reached, too. A maximum does not depend on the order.
  for (PointIndex p = 0; p < points_.size(); ++p) {
    if (!fires_[p].is_out) hand_on(p);
  }
  for (auto p = burned_.rbegin(); p != burned_.rend(); ++p) hand_on(*p);
}

}  // namespace bccskel
