#include "core/prepare/border_cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>
#include <unordered_set>
#include <utility>

#include "core/distance/places.h"
#include "core/lattice/directions.h"

namespace bccskel {
namespace {

using Points = std::unordered_set<LatticePoint, LatticePointHash>;

constexpr double kAsDeep = 0.75;  // depth of the middle of a cut, in its largest one
// How much deeper points on the same hill may be than those on the way, in their depth and units.
constexpr double kRise = 1.25, kRiseMargin = 2;
// Along a limb, in the depth of the middle. Toward the center of a ball it grows, beyond it falls.
constexpr double kLeastDepth = 0.8, kMostDepth = 1.2, kDepthMargin = 2;
// Least length of a limb, in half the width of its cut plus units.
constexpr double kLeastLimb = 1.2, kLimbMargin = 4;
constexpr double kRound = 1.3, kRoundMargin = 2;  // half the width of a round cut, in its depth
constexpr int kRays = 10;  // on either side of the normal, up to 45 degrees from it

std::array<int32_t, 3> ArrayOf(LatticePoint p) { return {p.x, p.y, p.z}; }

// Which way leads into the image from the faces on which p lies; zero if it lies on none.
Coordinates InwardAt(LatticePoint p, const LatticeBox& window) {
  const auto at = ArrayOf(p), low = ArrayOf(window.low), high = ArrayOf(window.high);
  Coordinates way = {0, 0, 0};
  for (size_t axis = 0; axis < 3; ++axis) {
    if (at[axis] == low[axis]) way[axis] = 1;
    if (at[axis] == high[axis]) way[axis] = -1;
  }
  return way;
}

class CutFinder {
 public:
  CutFinder(const LatticeBox& window, const Volume& object, const DistanceField& distance)
      : window_(window),
        object_(object),
        distance_(distance),
        scale_(AxisScaleOf(object.placement())),
        bricks_(object) {}

  BorderCuts Find() && {
    BorderCuts cuts{window_, scale_, {}, {}};
    const std::vector<LatticePoint> points = PointsOnFaces();
    std::vector<std::pair<double, LatticePoint>> tops;
    for (LatticePoint p : points) tops.emplace_back(-DepthAt(p), p);
    std::ranges::sort(tops);
    Points left(points.begin(), points.end());
    for (const auto& [height, top] : tops) {
      if (!left.contains(top)) continue;
      const std::vector<LatticePoint> hill = TakeHill(top, left);
      const LatticePoint middle = MiddleOf(hill);
      if (!CutsLimb(hill, middle)) continue;
      for (LatticePoint p : hill) cuts.points.emplace(p, cuts.middles.size());
      cuts.middles.push_back(middle);
    }
    return cuts;
  }

 private:
  double DepthAt(LatticePoint p) {
    const BrickAddress address = AddressOf(p);
    return distance_.ToLatticeUnits(distance_.At(bricks_.Find(address.brick), address.bit));
  }

  std::vector<LatticePoint> PointsOnFaces() const {
    const auto [low, high] = window_;
    const LatticeBox inside = {low + LatticePoint{1, 1, 1}, high - LatticePoint{1, 1, 1}};
    std::vector<LatticePoint> points;
    for (BrickIndex n = 0; n < object_.brick_count(); ++n) {
      const BrickCoordinates brick = object_.keys()[n].coordinates();
      if (inside.Contains(BoxOf(brick))) continue;
      const BrickBits on_faces = object_.bricks()[n] & ~PointsIn(brick, inside);
      on_faces.ForEachSetBit([&](int bit) { points.push_back(PointOf(brick, bit)); });
    }
    return points;
  }

  // Takes the hill of a point from `left`: the points to which ways lead down from it, but for what
  // noise may be. Two limbs that touch at the border are two hills.
  std::vector<LatticePoint> TakeHill(LatticePoint top, Points& left) {
    struct Step {
      double least;  // depth on the way
      LatticePoint to;
    };
    const auto later = [](const Step& a, const Step& b) {
      return a.least != b.least ? a.least < b.least : b.to < a.to;
    };
    std::priority_queue<Step, std::vector<Step>, decltype(later)> next(later);
    std::vector<LatticePoint> hill;
    const auto take = [&](LatticePoint p, double least) {
      if (!left.contains(p)) return;
      const double depth = DepthAt(p);
      if (depth > kRise * least + kRiseMargin) return;
      left.erase(p);
      hill.push_back(p);
      next.push({std::min(least, depth), p});
    };
    take(top, DepthAt(top));
    while (!next.empty()) {
      const Step step = next.top();
      next.pop();
      for (const LatticePoint& direction : kDirections14) take(step.to + direction, step.least);
    }
    return hill;
  }

  // Of the deep points, the one nearest to the centroid by depth.
  LatticePoint MiddleOf(const std::vector<LatticePoint>& hill) {
    const double least = kAsDeep * DepthAt(hill[0]);
    Coordinates sum = {0, 0, 0};
    double weight = 0;
    for (LatticePoint p : hill) {
      const double depth = DepthAt(p);
      sum = Sum(sum, depth, PlaceOf(p, scale_));
      weight += depth;
    }
    const Coordinates centroid = Times(1 / weight, sum);
    LatticePoint middle = hill[0];
    double nearest = std::numeric_limits<double>::infinity();
    for (LatticePoint p : hill) {
      const Coordinates way = Sum(PlaceOf(p, scale_), -1, centroid);
      if (Dot(way, way) >= nearest || DepthAt(p) < least) continue;
      nearest = Dot(way, way);
      middle = p;
    }
    return middle;
  }

  bool CutsLimb(const std::vector<LatticePoint>& part, LatticePoint middle) {
    const Coordinates from = PlaceOf(middle, scale_);
    double square = 0;
    for (LatticePoint p : part) {
      const Coordinates way = Sum(PlaceOf(p, scale_), -1, from);
      square = std::max(square, Dot(way, way));
    }
    const double depth = DepthAt(middle), wide = std::sqrt(square);
    const double round = kRound * depth + kRoundMargin;
    if (wide <= round) return false;
    const double least = kLeastLimb * wide + kLimbMargin;
    const Coordinates inward = Unit(InwardAt(middle, window_));
    const auto [first, second] = Across(inward);
    for (int u = -kRays; u <= kRays; ++u) {
      for (int v = -kRays; v <= kRays; ++v) {
        const Coordinates way =
            Unit(Sum(Sum(inward, 1.0 * u / kRays, first), 1.0 * v / kRays, second));
        // Seen along a limb that is round, a cut is, too.
        if (wide * Dot(way, inward) > round && IsLimbAlong(from, way, least, depth)) return true;
      }
    }
    return false;
  }

  bool IsLimbAlong(const Coordinates& from, const Coordinates& way, double length, double depth) {
    for (double gone = 0; gone <= length; gone += 2) {
      const LatticePoint p = PointNear(Sum(from, gone, way), scale_);
      if (!window_.Contains(p) || !bricks_.Contains(p)) return false;
      const double here = DepthAt(p);
      if (here < kLeastDepth * depth - kDepthMargin || here > kMostDepth * depth + 1) return false;
    }
    return true;
  }

  const LatticeBox window_;
  const Volume& object_;
  const DistanceField& distance_;
  const AxisScale scale_;
  NearbyBricks bricks_;
};

}  // namespace

std::optional<LatticePoint> BorderCuts::MiddleBeside(LatticePoint end, double reach) const {
  const auto own = points.find(end);
  if (own != points.end() && middles[own->second] == end) return std::nullopt;
  const auto at = ArrayOf(end), low = ArrayOf(window.low), high = ArrayOf(window.high);
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const int32_t face : {low[axis], high[axis]}) {
      if (scale[axis] * std::abs(face - at[axis]) > reach) continue;
      // A face has points of one sublattice.
      const int32_t odd = (face - at[axis]) % 2 != 0 ? 1 : 0;
      for (const int32_t u : {-odd, odd}) {
        for (const int32_t v : {-odd, odd}) {
          auto near = at;
          near[axis] = face;
          near[(axis + 1) % 3] += u;
          near[(axis + 2) % 3] += v;
          const auto cut = points.find({near[0], near[1], near[2]});
          if (cut != points.end()) return middles[cut->second];
        }
      }
    }
  }
  return std::nullopt;
}

BorderCuts FindBorderCuts(const Volume& space, const Volume& object,
                          const DistanceField& distance) {
  if (!space.window().has_value()) return {};
  return CutFinder(*space.window(), object, distance).Find();
}

}  // namespace bccskel
