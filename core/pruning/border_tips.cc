#include "core/pruning/border_tips.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/pruning/branch_walk.h"
#include "core/pruning/grow_along.h"

namespace bccskel {
namespace {

constexpr double kTouchMargin = 1;  // units between a ball and the border that it touches
constexpr double kFarRadii = 2;     // from an end to the border
// Length over which the way of a limb is measured, in its radius and units: wanted, and least.
constexpr double kBackRadii = 2, kBackMargin = 4, kLeastRadii = 0.75, kLeastMargin = 2;
constexpr double kLeastCosine = 0.3;              // between the limb and the normal of the border
constexpr double kMostWide = 4, kWideMargin = 2;  // from the middle to the surface, likewise
// How much the radius of a circle as large as the cut, seen along the limb, may differ from that of
// the section before: a share of it, and units.
constexpr double kMostChange = 0.25, kChangeMargin = 1;
constexpr double kPlaceStep = 2;  // units
// From a junction back along the trunk, in its radius; and how far off its axis the points of its
// end may lie.
constexpr double kTrunkRadii = 6, kTrunkWide = 1.25;
constexpr double kNearRadii = 4;                    // from a ball to the border
constexpr double kOtherLimb = 0.7;                  // radius of another limb, in that of the trunk
constexpr double kLeastBranch = 0.5;                // of a trunk, in the radius of its section
constexpr int kMostJunctions = 16;                  // along a trunk, which may be a loop
constexpr size_t kArmPoints = 8;                    // from the junction to where arms are compared
constexpr double kMostCurve = 8, kLeastCurve = 64;  // of a curve, per radius and in any case
constexpr int kRounds = 3;
constexpr double kLongestStep = 2;  // between neighbors, in the longest edge
constexpr double kToLattice = 1.2;  // from a place to the nearest lattice point, at most, likewise
// Position in the path of the point from which the way to the point at `n` is measured.
size_t BackFrom(std::span<const LatticePoint> path, size_t n, const ThinSet& set) {
  const double length = kBackRadii * set.RadiusOf(path[n]) + kBackMargin;
  size_t back = n;
  while (back > 0 && set.Between(path[back], path[n]) < length) --back;
  return back;
}

double RadiusOf(double area) { return std::sqrt(area / std::numbers::pi); }

}  // namespace

const TrunkArms::Arm& TrunkArms::Deepest(LatticePoint junction, LatticePoint own,
                                         const ThinSet& set) {
  const auto [known, is_new] = arms_.try_emplace({junction, own});
  if (is_new) known->second = Find(junction, own, set);
  return known->second;
}

TrunkArms::Arm TrunkArms::Find(LatticePoint junction, LatticePoint own, const ThinSet& set) {
  Arm deepest = {{}, junction};
  float most = 0;
  for (LatticePoint p : ClusterOf(set, junction)) {
    ForEachNeighbor(p, set.NeighborsOf(p), [&](LatticePoint q) {
      if (q == own || set.Branches(q)) return;
      std::vector<LatticePoint> arm = {p};
      const LatticePoint last = FollowCurve(set, p, q, arm);
      const float radius = set.RadiusOf(arm[std::min(arm.size() - 1, kArmPoints)]);
      if (radius <= most) return;
      most = radius;
      deepest = {std::move(arm), last};
    });
  }
  return deepest;
}

namespace {

// The points of the trunk from the junction back, through others.
std::vector<LatticePoint> TrunkTo(LatticePoint junction, LatticePoint own, const ThinSet& set,
                                  TrunkArms& arms) {
  std::vector<LatticePoint> trunk;
  const double length = kTrunkRadii * set.RadiusOf(junction) + kBackMargin;
  LatticePoint at = junction;
  for (int n = 0; n < kMostJunctions; ++n) {
    const auto& [arm, end] = arms.Deepest(at, own, set);
    trunk.insert(trunk.end(), arm.begin(), arm.end());
    if (arm.size() < 2 || !set.Branches(end) || set.Between(end, junction) > length) break;
    own = arm.back();
    at = end;
  }
  return trunk;
}

// The curve from p on, away from its neighbor `previous`, and through junctions along the trunk, as
// far as a limb is measured.
std::vector<LatticePoint> CurveFrom(LatticePoint previous, LatticePoint p, const ThinSet& set,
                                    TrunkArms& arms) {
  std::vector<LatticePoint> curve;
  LatticePoint last = previous, at = p;
  const double most = kMostCurve * set.RadiusOf(p) + kLeastCurve;
  while (IsCurvePoint(set.NeighborsOf(at)) && static_cast<double>(curve.size()) < most) {
    if (at == previous) return curve;  // a loop
    curve.push_back(at);
    const LatticePoint next = NextPoint(at, set.NeighborsOf(at), last);
    last = at;
    at = next;
  }
  if (!set.Branches(at)) return curve;
  const std::vector<LatticePoint> trunk = TrunkTo(at, last, set, arms);
  curve.insert(curve.end(), trunk.begin(), trunk.end());
  return curve;
}

}  // namespace

BorderTips::BorderTips(const Volume& object, const LatticeBox& image)
    : scale_(AxisScaleOf(object.placement())),
      low_(PlaceOf(image.low, scale_)),
      high_(PlaceOf(image.high, scale_)),
      bricks_(object),
      sections_(object) {}

double BorderTips::OutFrom(const Coordinates& place, const Face& face) const {
  const size_t axis = face.axis;
  return face.side > 0 ? high_[axis] - place[axis] : place[axis] - low_[axis];
}

std::vector<BorderTips::Face> BorderTips::FacesNear(LatticePoint p, double reach) const {
  const Coordinates place = PlaceOf(p, scale_);
  std::vector<Face> faces;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const int32_t side : {-1, 1}) {
      if (OutFrom(place, {axis, side}) <= reach) faces.push_back({axis, side});
    }
  }
  if (faces.size() < 2) return faces;  // nearly always
  std::ranges::stable_sort(faces, {}, [&](const Face& face) { return OutFrom(place, face); });
  return faces;
}

// Moves the middle to the centroid of what rays from it see, a few times. None if the object then
// extends to `reach`; before, where the middle may lie on one side, to twice as far.
std::optional<BorderTips::Section> BorderTips::SectionAt(Coordinates middle,
                                                         const std::array<Coordinates, 2>& plane,
                                                         double reach) {
  Section section;
  for (int round = 1; round <= kRounds; ++round) {
    const double most = round < kRounds ? 2 * reach : reach;
    section = {middle, 0};
    RayLengths lengths;
    RayWays ways;
    for (size_t n = 0; n < kRays; ++n) {
      ways[n] = RayIn(plane, n);
      lengths[n] = sections_.WayOut(middle, ways[n], 0, most) + 0.5;
      if (lengths[n] >= most) return std::nullopt;
    }
    const RayPolygon seen = PolygonOf(ways, lengths);
    section.area = seen.area;
    section.middle = middle = Sum(middle, 1, seen.middle);
  }
  return section;
}

bool BorderTips::TouchesAcross(const Face& face, std::span<const LatticePoint> path, size_t n,
                               const ThinSet& set) {
  const double radius = set.RadiusOf(path[n]);
  const double reach = kMostWide * radius + kWideMargin;
  const size_t back = BackFrom(path, n, set);
  if (back == n) return false;
  const auto plane = Across(Unit(set.Way(path[back], path[n])));
  const Coordinates middle = PlaceOf(path[n], scale_);
  const double out = OutFrom(middle, face) - kTouchMargin;
  // The ball around the point lies in the object.
  const double start = std::floor(std::max(radius - kToLattice * std::ranges::max(scale_), 0.0));
  for (size_t ray = 0; ray < kRays; ++ray) {
    const Coordinates way = RayIn(plane, ray);
    const double toward = face.side * way[face.axis];
    if (toward <= 0 || out > (reach + 1) * toward) continue;  // it does not get there
    const double length = out / toward - 1;
    if (sections_.WayOut(middle, way, start, std::max(std::ceil(length), 0.0)) >= length) {
      return true;
    }
  }
  return false;
}

std::optional<BorderTips::Limb> BorderTips::LimbBefore(const Face& face,
                                                       std::span<const LatticePoint> path,
                                                       const ThinSet& set) {
  size_t from = path.size() - 1;
  while (from > 0 && Touches(path[from], face, set)) --from;
  // Of a wide limb, the border may cut off a part of the section there.
  while (from > 0 && TouchesAcross(face, path, from, set)) --from;
  const double radius = set.RadiusOf(path[from]);
  const size_t back = BackFrom(path, from, set);
  if (set.Between(path[back], path[from]) < kLeastRadii * radius + kLeastMargin) {
    return std::nullopt;
  }
  Limb limb;
  limb.from = from;
  limb.way = Unit(set.Way(path[back], path[from]));
  limb.reach = kMostWide * radius + kWideMargin;
  const auto plane = Across(limb.way);
  const auto last = SectionAt(PlaceOf(path[from], scale_), plane, limb.reach);
  if (!last.has_value()) return std::nullopt;
  const auto before = SectionAt(PlaceOf(path[back], scale_), plane, limb.reach);
  limb.last = *last;
  limb.start = last->middle;
  if (before.has_value()) {
    const Coordinates way = Sum(last->middle, -1, before->middle);
    if (Dot(way, limb.way) > 0) limb.way = Unit(way);
  }
  return limb;
}

std::optional<BorderTips::Limb> BorderTips::TrunkBefore(const Face& face,
                                                        std::span<const LatticePoint> path,
                                                        LatticePoint junction, const ThinSet& set) {
  TrunkArms arms;  // the set changes from one tip to the next
  std::vector<LatticePoint> whole = TrunkTo(junction, path[0], set, arms);
  if (whole.empty()) return std::nullopt;
  std::ranges::reverse(whole);
  std::optional<Limb> limb = LimbBefore(face, whole, set);
  if (!limb.has_value()) return std::nullopt;
  const double wide = kTrunkWide * RadiusOf(limb->last.area);
  const bool beside = std::ranges::any_of(path, [&](LatticePoint p) {
    const Coordinates to = Sum(PlaceOf(p, scale_), -1, limb->last.middle);
    const Coordinates off = Sum(to, -Dot(to, limb->way), limb->way);
    return Dot(off, off) > wide * wide;
  });
  if (beside) return std::nullopt;
  limb->from = 0;
  limb->start = PlaceOf(path[0], scale_);
  return limb;
}

std::optional<Coordinates> BorderTips::MiddleOfCut(const Face& face, const Limb& limb) {
  const double cosine = face.side * limb.way[face.axis];
  if (cosine < kLeastCosine) return std::nullopt;
  // A unit inside the face lie the middles of voxels.
  const double unit = scale_[face.axis], length = (OutFrom(limb.last.middle, face) - unit) / cosine;
  const double steps = std::max(std::floor(length), 0.0);
  if (sections_.WayOut(limb.last.middle, limb.way, 0, steps) < steps) return std::nullopt;
  std::array<Coordinates, 2> plane = {};
  plane[0][(face.axis + 1) % 3] = plane[1][(face.axis + 2) % 3] = 1;
  const Coordinates straight_on = Sum(limb.last.middle, length, limb.way);
  const auto cut = SectionAt(straight_on, plane, limb.reach / cosine);
  if (!cut.has_value()) return std::nullopt;
  const double wide = RadiusOf(limb.last.area), change = RadiusOf(cut->area * cosine) - wide;
  if (std::abs(change) > kMostChange * wide + kChangeMargin) return std::nullopt;
  return Sum(cut->middle, unit / cosine, limb.way);
}

BorderTips::Way BorderTips::StraightTo(const Coordinates& middle, const Face& face,
                                       const Limb& limb) {
  Way way = {face.axis, limb.from, {}};
  const Coordinates straight = Sum(middle, -1, limb.start);
  const auto steps = static_cast<int>(std::ceil(LengthOf(straight) / kPlaceStep));
  for (int n = 1; n <= steps; ++n) {
    way.places.push_back(Sum(limb.start, 1.0 * n / steps, straight));
  }
  return way;
}

std::optional<BorderTips::Way> BorderTips::WayOf(std::span<const LatticePoint> path,
                                                 const std::optional<LatticePoint>& junction,
                                                 const ThinSet& set) {
  const LatticePoint end = path.back();
  for (const Face& face : FacesNear(end, kFarRadii * set.RadiusOf(end) + kTouchMargin)) {
    std::optional<Limb> limb = LimbBefore(face, path, set);
    if (!limb.has_value() && junction.has_value()) limb = TrunkBefore(face, path, *junction, set);
    if (!limb.has_value()) continue;
    const std::optional<Coordinates> middle = MiddleOfCut(face, *limb);
    if (middle.has_value()) return StraightTo(*middle, face, *limb);
  }
  return std::nullopt;
}

bool BorderTips::Touches(LatticePoint p, const Face& face, const ThinSet& set) const {
  return OutFrom(PlaceOf(p, scale_), face) <= set.RadiusOf(p) + kTouchMargin;
}

std::vector<BorderTips::Crossing> BorderTips::Crossings(const ThinSet& set) const {
  constexpr int kOfSurface = 6;  // neighbors; junctions of curves rarely have as many
  const auto on_surface = [&](LatticePoint p) {
    return std::popcount(set.NeighborsOf(p)) >= kOfSurface;
  };
  // Along a step, the way to the face and the radius change at most by its length.
  const double most_change = 2 * kLongestStep * std::ranges::max(scale_) + kTouchMargin;
  std::vector<Crossing> crossings;
  set.ForEachBall([&](LatticePoint p, float radius) {
    const double near = std::min<double>(kNearRadii * radius, radius + most_change) + kTouchMargin;
    for (const Face& face : FacesNear(p, near)) {
      if (Touches(p, face, set)) continue;
      ForEachNeighbor(p, set.NeighborsOf(p), [&](LatticePoint q) {
        // Not within a surface, which has very many.
        if (on_surface(p) && on_surface(q)) return;
        if (Touches(q, face, set)) crossings.push_back({face, p, q});
      });
    }
  });
  std::ranges::sort(crossings, {}, [](const Crossing& c) {
    return std::tuple(c.face.axis, c.face.side, c.last, c.touching);
  });
  return crossings;
}

bool BorderTips::Cut::HasOneOf(std::span<const LatticePoint> ends, const ThinSet& set) const {
  return std::ranges::any_of(ends,
                             [&](LatticePoint end) { return set.Between(end, middle) <= radius; });
}

// Each crossing is tried as if no other got a branch; of several that lead to one cut, the first
// does.
void BorderTips::AddBranches(ExactRadius& radius, ThinSet& set, PointsByAxis& added,
                             const exec::Context& context) {
  constexpr size_t kAtOnce = 4;
  const auto may_add = [&](LatticePoint p) { return bricks_.Contains(p); };
  const std::vector<LatticePoint> ends = set.Ends();
  const std::vector<Crossing> crossings = Crossings(set);
  std::vector<LatticePoint> points;  // of the set
  set.ForEachPoint([&](LatticePoint p) { points.push_back(p); });
  std::vector<std::optional<NewBranch>> branches(crossings.size());
  const int workers = context.WorkersFor(crossings.size(), kWork);
  (void)context.ForEach(workers, crossings.size(), kAtOnce, [&](int) {
    return [&, own = *this, arms = TrunkArms()](size_t n) mutable {
      branches[n] = own.BranchFrom(crossings[n], ends, points, set, arms);
    };
  });
  std::vector<LatticePoint> new_ends;
  for (const std::optional<NewBranch>& branch : branches) {
    if (!branch.has_value() || branch->cut.HasOneOf(new_ends, set)) continue;
    std::vector<LatticePoint> path = {branch->from};
    if (!GrowAlong(branch->way.places, 0, may_add, path, set)) continue;
    for (size_t n = 1; n < path.size(); ++n) set.SetRadius(path[n], radius.At(path[n]));
    new_ends.push_back(path.back());
    std::vector<LatticePoint>& of_axis = added[branch->way.axis];
    of_axis.insert(of_axis.end(), path.begin() + 1, path.end());
  }
}

// A bent limb, such as a ring, may graze the face.
bool BorderTips::GoesOnAsThick(const Crossing& crossing, const ThinSet& set,
                               TrunkArms& arms) const {
  const std::vector<LatticePoint> beyond = CurveFrom(crossing.last, crossing.touching, set, arms);
  const auto leaves =
      std::ranges::find_if(beyond, [&](LatticePoint p) { return !Touches(p, crossing.face, set); });
  const float radius = set.RadiusOf(crossing.last);
  const auto outside = std::find_if(leaves, beyond.end(), [&](LatticePoint p) {
    return set.Between(p, *leaves) >= kBackRadii * radius;
  });
  return outside != beyond.end() && set.RadiusOf(*outside) > kOtherLimb * radius;
}

std::optional<BorderTips::NewBranch> BorderTips::BranchFrom(const Crossing& crossing,
                                                            std::span<const LatticePoint> ends,
                                                            std::span<const LatticePoint> points,
                                                            const ThinSet& set, TrunkArms& arms) {
  const auto& [face, p, touching] = crossing;
  std::vector<LatticePoint> trunk = CurveFrom(touching, p, set, arms);
  if (trunk.size() < 2 || GoesOnAsThick(crossing, set, arms)) return std::nullopt;
  std::ranges::reverse(trunk);
  std::optional<Limb> limb = LimbBefore(face, trunk, set);
  if (!limb.has_value()) return std::nullopt;
  const std::optional<Coordinates> middle = MiddleOfCut(face, *limb);
  if (!middle.has_value()) return std::nullopt;
  const double wide = RadiusOf(limb->last.area);
  const Cut cut = {*middle, kTrunkWide * wide};
  if (cut.HasOneOf(ends, set)) return std::nullopt;
  const auto square_to = [&](LatticePoint other) {
    const Coordinates way = Sum(PlaceOf(other, scale_), -1, *middle);
    return Dot(way, way);
  };
  LatticePoint nearest = p;
  double least = square_to(p);
  for (LatticePoint other : points) {
    const double square = square_to(other);
    if (square > least || (square == least && nearest < other)) continue;
    nearest = other;
    least = square;
  }
  if (std::sqrt(least) < kLeastBranch * wide) return std::nullopt;
  limb->start = PlaceOf(nearest, scale_);
  return NewBranch{nearest, StraightTo(*middle, face, *limb), cut};
}

}  // namespace bccskel
