#include "core/pruning/limb_anchor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bccskel {
namespace {

constexpr double kAnchorRadii = 4;    // distance of the anchor from the end, in radii
constexpr double kAnchorSteps = 5;    // plus steps
constexpr double kStraightRadii = 2;  // shorter parts give no direction, bent or not
constexpr double kBendRadii = 0.35;   // limbs that deviate more from a straight line bend, in radii
constexpr double kBendMargin = 2;     // plus lattice units
constexpr size_t kBendStride = 8;     // points between checks
constexpr size_t kBendSamples = 16;
constexpr size_t kLeastOnArc = 5;  // points
constexpr double kWayRadii = 2;    // length of the ridge's last part, which shows how it continues
constexpr double kFreeRadii = 0.25;  // distance from the continuation without penalty, in radii
constexpr double kFreeMargin = 1;    // plus lattice units
// Of ridges that turn away.
constexpr double kTurnRadii = 0.75;
constexpr double kTurnMargin = 2;       // plus lattice units
constexpr double kBodyTurnRadii = 1.2;  // the same for bodies
constexpr double kBodySlope = 0.45;     // instead of kRidgeSlope
constexpr double kThickerBody = 1.4;    // least radius, in radii of the limb

// Position of the last point, within a cap at the end, up to which the radius certainly follows a
// ridge: beyond it the path may turn into a corner. The end comes first.
size_t RidgeEnd(const ThinSet& set, std::span<const LatticePoint> points) {
  size_t ridge_end = 0;
  double length = 0, most = set.RadiusOf(points[0]);
  for (size_t n = 1; n < points.size(); ++n) {
    length += set.Between(points[n - 1], points[n]);
    const double radius = set.RadiusOf(points[n]);
    if (set.Between(points[0], points[n]) > kCutRadii * radius + kCutMargin) break;
    if (radius - kRidgeSlope * length <= most) continue;
    ridge_end = n;
    most = radius - kRidgeSlope * length;
  }
  return ridge_end;
}

// How far p lies from a in the direction of q, by the law of cosines.
double AlongFrom(const ThinSet& set, LatticePoint a, LatticePoint q, LatticePoint p) {
  const double ap = set.Between(a, p), pq = set.Between(p, q), aq = set.Between(a, q);
  return (ap * ap + aq * aq - pq * pq) / (2 * aq);
}

// Whether points whose ends are at least this far apart deviate from a straight line by more than a
// share of their median radius.
bool Bends(const ThinSet& set, std::span<const LatticePoint> points, double least) {
  const LatticePoint a = points.front(), b = points.back();
  if (set.Between(a, b) < least) return false;
  std::vector<float> radii;
  double farthest = 0;  // squared
  const size_t last = points.size() - 1, stride = last / kBendSamples + 1;
  for (size_t n = 0; n < last; n += stride) {
    radii.push_back(set.RadiusOf(points[n]));
    const double way = set.Between(a, points[n]), along = AlongFrom(set, a, b, points[n]);
    farthest = std::max(farthest, way * way - along * along);
  }
  const double allowed = kBendRadii * MedianOf(std::move(radii)) + kBendMargin;
  return farthest > allowed * allowed;
}

// The position before which the anchor lies: beyond the points, at the junction. A path without one
// leads to another end, where it may turn into a corner, too: there it is where the ridge begins.
size_t FarthestAnchor(const ThinSet& set, const FreeBranch& branch) {
  const size_t size = branch.points.size();
  if (branch.junction.has_value()) return size;
  const std::vector<LatticePoint> back(branch.points.rbegin(), branch.points.rend());
  return std::max(size - 1 - RidgeEnd(set, back), size / 2);
}

// Position in the path of the last point up to which the depth falls by less than `slope` per unit
// of the path, wherever that leads.
size_t RidgeEndBy(double slope, const ThinSet& set, FirmDepth& depth, const LimbEnd& limb) {
  size_t best = limb.first;
  double length = 0, most = depth.At(limb.path[limb.first]);
  for (size_t n = limb.first + 1; n < limb.path.size(); ++n) {
    length += set.Between(limb.path[n - 1], limb.path[n]);
    const double merit = slope * length + depth.At(limb.path[n]);
    if (merit < most) continue;
    best = n;
    most = merit;
  }
  return best;
}

}  // namespace

LatticePoint TakeAnchor(const ThinSet& set, FreeBranch& branch) {
  const double step = std::ranges::max(set.scale());
  std::vector<LatticePoint>& points = branch.points;
  const size_t front = RidgeEnd(set, points);
  const size_t farthest = FarthestAnchor(set, branch);
  double length = 0;
  float radius = set.RadiusOf(points[0]);
  for (size_t n = 1; n < farthest; ++n) {
    length += set.Between(points[n - 1], points[n]);
    radius = std::max(radius, set.RadiusOf(points[n]));
    const bool is_far = length >= kAnchorRadii * radius + kAnchorSteps * step;
    const bool may_bend = length >= kStraightRadii * set.RadiusOf(points[n]) + kAnchorSteps * step;
    const bool is_checked = may_bend && front < n && n % kBendStride == 0;
    const auto between = std::span(points).subspan(front, is_checked ? n - front + 1 : 0);
    if (!is_far && !(is_checked && Bends(set, between, kLeastAim * step))) continue;
    const LatticePoint anchor = points[n];
    points.resize(n);
    return anchor;
  }
  if (branch.junction.has_value()) return *branch.junction;
  const LatticePoint anchor = points[farthest];
  points.resize(farthest);
  return anchor;
}

std::optional<Coordinates> DirectionOnArc(const ThinSet& set, std::span<const LatticePoint> points,
                                          double ahead, double most_off) {
  if (points.size() < kLeastOnArc) return std::nullopt;
  const auto count = static_cast<double>(points.size());
  std::vector<double> at = {0};  // lengths along the curve
  double mean = 0;
  for (size_t n = 1; n < points.size(); ++n) {
    at.push_back(at.back() + set.Between(points[n - 1], points[n]));
    mean += at.back() / count;
  }
  // In u, the way from the mean in half lengths, 1, u and bow(u) are orthogonal polynomials.
  const double half = at.back() / 2;
  double squares = 0, cubes = 0;
  for (double& u : at) {
    u = (u - mean) / half;
    squares += u * u;
    cubes += u * u * u;
  }
  const double skew = cubes / squares;
  const auto bow = [&](double u) { return u * u - skew * u - squares / count; };
  Coordinates middle = {}, slope = {}, bend = {};
  double weight = 0;
  for (size_t n = 0; n < points.size(); ++n) {
    const Coordinates place = set.Way(points[0], points[n]);
    middle = Sum(middle, 1 / count, place);
    slope = Sum(slope, at[n] / squares, place);
    bend = Sum(bend, bow(at[n]), place);
    weight += bow(at[n]) * bow(at[n]);
  }
  bend = Times(1 / weight, bend);
  double off = 0;  // squared
  for (size_t n = 0; n < points.size(); ++n) {
    const Coordinates fitted = Sum(Sum(middle, at[n], slope), bow(at[n]), bend);
    const Coordinates rest = Sum(set.Way(points[0], points[n]), -1, fitted);
    off += Dot(rest, rest) / count;
  }
  if (off >= most_off * most_off * Dot(bend, bend)) return std::nullopt;
  return Unit(Sum(slope, 2 * (at.back() + ahead / half) - skew, bend));
}

double WayOn::Aside(const Coordinates& to) const {
  const double along = Dot(way, to);
  if (along <= 0) return 0;
  return std::max(std::sqrt(std::max(Dot(to, to) - along * along, 0.0)) - free, 0.0);
}

WayOn StraightOn(const Coordinates& way, double radius) {
  return {Unit(way), kFreeRadii * radius + kFreeMargin};
}

WayOn WayOnFrom(const ThinSet& set, LatticePoint anchor, std::span<const LatticePoint> path) {
  const double step = std::ranges::max(set.scale());
  const LatticePoint end = path.back();
  const double radius = set.RadiusOf(end), back = std::max(kWayRadii * radius, kLeastAim * step);
  size_t n = path.size() - 1;
  while (n > 0 && set.Between(path[n], end) < back) --n;
  const LatticePoint before = n > 0 ? path[n] : anchor;
  const bool too_near = before == end || set.Between(before, end) < kLeastWayRadii * radius;
  return too_near ? WayOn() : StraightOn(set.Way(before, end), radius);
}

std::optional<size_t> RidgeEndAside(const ThinSet& set, FirmDepth& depth, const LimbEnd& limb) {
  const size_t end = RidgeEndBy(kRidgeSlope, set, depth, limb);
  const double least = kTurnRadii * set.RadiusOf(limb.path[end]) + kTurnMargin;
  if (set.Between(limb.straight, limb.path[end]) > least) return end;
  const size_t body_end = RidgeEndBy(kBodySlope, set, depth, limb);
  const LatticePoint body =
      *std::ranges::max_element(limb.path.subspan(limb.first, body_end + 1 - limb.first), {},
                                [&](LatticePoint p) { return set.RadiusOf(p); });
  const double radius = set.RadiusOf(body);
  if (radius < kThickerBody * limb.radius) return std::nullopt;
  const double far = kBodyTurnRadii * radius + kTurnMargin;
  if (set.Between(body, limb.path[body_end]) < far) return std::nullopt;
  return body_end;
}

}  // namespace bccskel
