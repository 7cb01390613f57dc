#include "core/pruning/grow_along.h"

#include <optional>
#include <utility>

namespace bccskel {
namespace {

constexpr double kNear = 1.5;    // a place this near is reached, lattice units
constexpr double kMostLeft = 3;  // from the end to the last place

void CutBehind(size_t from, std::vector<LatticePoint>& path, ThinSet& set) {
  while (path.size() > from + 1) {
    set.Remove(path.back());
    path.pop_back();
  }
}

// The free neighbor of the end that is nearest to the place, if it is nearer than the end.
std::optional<LatticePoint> NextToward(const Coordinates& place, LatticePoint end,
                                       const std::function<bool(LatticePoint)>& may_add,
                                       const ThinSet& set) {
  std::optional<LatticePoint> next;
  double least = set.Between(end, place);
  for (const LatticePoint offset : kDirections14) {
    const LatticePoint to = end + offset;
    const double way = set.Between(to, place);
    if (way >= least || set.Contains(to) || !IsEndPoint(set.NeighborsAround(to))) continue;
    if (!may_add(to)) continue;
    next = to;
    least = way;
  }
  return next;
}

}  // namespace

bool GrowAlong(std::span<const Coordinates> places, size_t from,
               const std::function<bool(LatticePoint)>& may_add, std::vector<LatticePoint>& path,
               ThinSet& set) {
  std::vector<std::pair<LatticePoint, float>> before;
  for (size_t n = from + 1; n < path.size(); ++n) {
    before.emplace_back(path[n], set.RadiusOf(path[n]));
  }
  CutBehind(from, path, set);
  for (const Coordinates& place : places) {
    while (set.Between(path.back(), place) >= kNear) {
      const std::optional<LatticePoint> next = NextToward(place, path.back(), may_add, set);
      if (!next.has_value()) break;  // the next place may be reached from here
      set.Add(*next, 0);
      path.push_back(*next);
    }
  }
  if (set.Between(path.back(), places.back()) < kMostLeft) return true;
  CutBehind(from, path, set);
  for (const auto& [p, radius] : before) {
    set.Add(p, radius);
    path.push_back(p);
  }
  return false;
}

}  // namespace bccskel
