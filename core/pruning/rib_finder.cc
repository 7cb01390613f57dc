#include "core/pruning/rib_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace bccskel {
namespace {

constexpr double kLeastWidth = 0.75;  // half the width where ribs are, in lengths of the branch
constexpr double kFlatness = 2.5;     // the same in radii
constexpr double kReach = 1.5;        // of rays, in lengths of the branch
constexpr size_t kPlaces = 5;         // a tenth of the branch apart, the first next to its end
constexpr size_t kNarrowPlaces = 2;   // that many show that it is no rib
constexpr size_t kWayReach = 5;       // points on either side that give the branch's way
constexpr int kSquare = 4;            // rays go through the rim of a square of 9 by 9 points,
constexpr std::array<int, 8> kSteps = {-4, 0, -3, -2, -1, 1, 2, 3};  // first an eighth turn apart:
constexpr int kFirstBetween = -3;  // in a flat limb one of those is within 22.5 degrees of it and
constexpr double kHint = 2;        // goes on for 2.6 radii, on either side

}  // namespace

RibFinder::RibFinder(const Volume& object)
    : scale_(AxisScaleOf(object.placement())), bricks_(object) {}

bool RibFinder::IsRib(const ThinSet& set, const FreeBranch& branch) {
  const LatticePoint end = branch.points[0];
  const Verdict* last = verdicts_.Find(end);
  if (last != nullptr && last->junction == *branch.junction &&
      last->points == branch.points.size()) {
    return last->is_rib;
  }
  const bool is_rib = Look(set, branch);
  verdicts_.Set(end, {*branch.junction, branch.points.size(), is_rib});
  return is_rib;
}

bool RibFinder::Look(const ThinSet& set, const FreeBranch& branch) {
  const double length = set.Between(branch.points[0], *branch.junction);
  size_t narrow = 0;
  for (size_t place = 1; place <= kPlaces && narrow < kNarrowPlaces; ++place) {
    const size_t n = branch.points.size() * place / (2 * kPlaces);
    const LatticePoint p = branch.points[n];
    if (!IsWideAcross(WayAt(branch, n), p, set.RadiusOf(p), length)) ++narrow;
  }
  return narrow < kNarrowPlaces;
}

// The way of the branch around its point n, of length 1.
Coordinates RibFinder::WayAt(const FreeBranch& branch, size_t n) const {
  const LatticePoint from = branch.points[n - std::min(n, kWayReach)];
  const size_t after = n + kWayReach;
  const LatticePoint to = after < branch.points.size() ? branch.points[after] : *branch.junction;
  return Unit(Sum(PlaceOf(to, scale_), -1, PlaceOf(from, scale_)));
}

bool RibFinder::IsWideAcross(const Coordinates& way, LatticePoint p, double radius, double length) {
  const double wide = 2 * std::max(kLeastWidth * length, kFlatness * radius);
  const double reach = kReach * length;
  const double start = std::floor(radius);
  const Coordinates middle = PlaceOf(p, scale_);
  const auto [u, v] = Across(way);
  double widest = 0;
  for (const int i : kSteps) {
    if (i == kFirstBetween && widest < 2 * kHint * radius) return false;
    for (const auto& [a, b] : {std::pair(kSquare, i), std::pair(-i, kSquare)}) {
      const Coordinates side = Unit(Sum(Sum({0, 0, 0}, a, u), b, v));
      const double there = WayOut(middle, side, start, reach);
      if (there + reach < wide) continue;
      const double back = WayOut(middle, Sum({0, 0, 0}, -1, side), start, reach);
      widest = std::max(widest, there + back);
      if (widest >= wide) return true;
    }
  }
  return false;
}

// How far the object goes on, up to `reach`, in whole lattice units. Needs: it does up to `start`.
double RibFinder::WayOut(const Coordinates& from, const Coordinates& way, double start,
                         double reach) {
  double out = start;
  while (out < reach && InObject(Sum(from, out + 1, way))) ++out;
  return out;
}

bool RibFinder::InObject(const Coordinates& place) {
  return bricks_.Contains(PointNear(place, scale_));
}

}  // namespace bccskel
