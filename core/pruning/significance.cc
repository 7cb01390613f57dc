#include "core/pruning/significance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/distance/points_along.h"

namespace bccskel {
namespace {

constexpr double kWallSteepness = 0.4;  // of what its inscribed circle shrinks by
constexpr double kWidthShare = 2.2;     // of what the object is wider than thick
constexpr double kNoiseMargin = 2;      // lattice units more, as noise goes off the square
constexpr double kSureRatio = 2;        // above, what lies beyond the end does not matter
constexpr double kLeastRatio = 0.2;     // below, the width is not looked at: the branch is a bump
constexpr double kLeastFine = 0.35;     // below, the width is looked at in few directions
constexpr size_t kRoots = 7;            // of the places, the first: there the limb may begin
constexpr size_t kNearTip = 9;          // of the places
constexpr double kLongestRay = 400;
constexpr double kRoundness = 1.5;  // half-width by radius: a plate is wider in one of eight lines
constexpr double kRoundMargin = 1;
constexpr double kWallFlatness = 2.5;  // half-width by radius: less is round
constexpr double kWallMargin = 3;      // so are limbs as thick as the steps of the surface
constexpr double kMostThick = 3;  // of a wall to either side, in radii: beyond, another wall begins
constexpr double kLeastOn = 0.25;    // a line goes on in a wall by this at least, in radii
constexpr double kBulge = 1.2;       // its radius at the end, in radii where its branch begins
constexpr double kInJunction = 0.9;  // of the ball there
constexpr size_t kCoverSamples = 16;

// Half a turn in eight steps: cosine and sine.
constexpr std::array<std::array<double, 2>, 8> kTurns = {{{1, 0},
                                                          {0.92387953, 0.38268343},
                                                          {0.70710678, 0.70710678},
                                                          {0.38268343, 0.92387953},
                                                          {0, 1},
                                                          {-0.38268343, 0.92387953},
                                                          {-0.70710678, 0.70710678},
                                                          {-0.92387953, 0.38268343}}};

// Tangents of smaller turns to either side of the widest of these.
constexpr double kFirstTurn = 0.2, kLeastTurn = 0.01;

BranchPath PathOf(const ThinSet& set, const FreeBranch& branch) {
  BranchPath path{{*branch.junction}, {}};
  path.points.insert(path.points.end(), branch.points.rbegin(), branch.points.rend());
  for (LatticePoint p : path.points) path.radii.push_back(set.RadiusOf(p));
  return path;
}

// Position in the path of one of the kPlaces places of a run.
size_t PlaceIn(const Run& run, size_t place) {
  return run.from + (run.to - run.from) * place / (Significance::kPlaces - 1);
}

// For a bulge, thicker than the limb that it sits on, the first place outside the ball at the
// junction: inside, lines across the branch run along that limb.
size_t FirstOwnPlace(const ThinSet& set, const BranchPath& path, const Run& run) {
  if (path.radii[run.to] < kBulge * path.radii[0]) return 0;
  size_t place = 0;
  const auto way = [&] { return set.Between(path.points[0], path.points[PlaceIn(run, place)]); };
  while (place + 1 < Significance::kPlaces && way() < kInJunction * path.radii[0]) ++place;
  return place;
}

// The median of the values from `place` on.
double MedianFrom(std::array<double, Significance::kPlaces> values, size_t place) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(place);
  const auto middle = first + (values.end() - first) / 2;
  std::nth_element(first, middle, values.end());
  return *middle;
}

}  // namespace

Significance::Significance(const Volume& object, const SurfaceNoise& noise,
                           std::optional<TipExtender> extender, std::optional<FirmDepth> firm_depth,
                           const std::optional<LatticeBox>& border)
    : noise_(noise),
      scale_(AxisScaleOf(object.placement())),
      bricks_(object),
      extender_(std::move(extender)),
      firm_depth_(std::move(firm_depth)),
      border_(border) {}

double Significance::Of(const ThinSet& set, const FreeBranch& branch) {
  const Verdict* last = Known(branch);
  if (last == nullptr) {
    verdicts_.Set(branch.points[0], Look(set, branch));
    last = verdicts_.Find(branch.points[0]);
  }
  if (last->value < kLeastRatio) return last->value;
  return last->value * UncoveredShare(set, branch, last->run);
}

double Significance::OfPath(const ThinSet& set, std::array<BranchPath, 2> ways) const {
  double elongation = 0;
  for (BranchPath& way : ways) {
    ExtendAcrossBorder(border_, scale_, way);
    elongation += LargestElongation(set, way);
  }
  return (elongation - noise_.step) / ways[0].radii[0];
}

void Significance::LookAhead(const ThinSet& set, std::span<const FreeBranch> branches,
                             const exec::Context& context) {
  std::vector<const FreeBranch*> unknown;
  for (const FreeBranch& branch : branches) {
    if (Known(branch) == nullptr) unknown.push_back(&branch);
  }
  const int workers = context.WorkersFor(unknown.size(), kWork);
  if (workers > 1) {  // else Of() looks as well
    std::vector<Verdict> found(unknown.size());
    exec::Portions portions(unknown.size(), 1);
    context.Offer(workers, [&](int) {
      Significance own = *this;
      for (exec::Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
        if (context.ShouldStop()) return;
        found[mine.begin] = own.Look(set, *unknown[mine.begin]);
      }
    });
    if (context.ShouldStop()) return;
    for (size_t n = 0; n < unknown.size(); ++n) verdicts_.Set(unknown[n]->points[0], found[n]);
  }
  if (!balls_.has_value()) balls_.emplace(set, scale_, context);  // now: workers need no copies
}

const Significance::Verdict* Significance::Known(const FreeBranch& branch) const {
  const Verdict* last = verdicts_.Find(branch.points[0]);
  if (last == nullptr || last->junction != *branch.junction) return nullptr;
  return last->points == branch.points.size() ? last : nullptr;
}

// The largest run may begin in something wide and reach the limb late, so the run of its later half
// is evaluated, too, then that of the later half of this one, and so on.
Significance::Verdict Significance::Look(const ThinSet& set, const FreeBranch& branch) {
  BranchPath path = PathOf(set, branch);
  Verdict best{*branch.junction, branch.points.size(), RunOf(set, path)};
  best.value = best.run.ratio;
  if (best.run.ratio < kLeastRatio) return best;
  best.value = ValueOf(set, path, best.run);
  size_t first = PlaceIn(best.run, kPlaces / 2);
  while (first + kPlaces <= path.points.size()) {
    const Run run = LargestRun(set, path, noise_, first);
    if (run.ratio < kLeastRatio) break;
    if (ValueAtMost(set, path, run) > best.value) {
      const double value = ValueOf(set, path, run);
      if (value > best.value) best.run = run, best.value = value;
    }
    const size_t later = PlaceIn(run, kPlaces / 2);
    if (later == first) break;
    first = later;
  }
  return best;
}

// Shape and noise are independent, so their squares add. The margin is for the thinnest limbs, for
// which this is less than the noise itself.
double Significance::BeyondNoise(double elongation, double radius, const Coordinates& way) const {
  const double noise = noise_.Stretch(way) * (noise_.At(radius) + kNoiseMargin);
  if (elongation <= noise) return elongation - noise;
  return std::sqrt(elongation * elongation - noise * noise);
}

// An upper bound: being wider than thick only lowers the value.
double Significance::ValueAtMost(const ThinSet& set, const BranchPath& path, const Run& run) const {
  double most = 0;
  for (size_t place = 0; place < kRoots; ++place) {
    const size_t root = PlaceIn(run, place);
    const double depth = path.radii[root];
    for (size_t later = place + 1; later < kPlaces; ++later) {
      const size_t tip = PlaceIn(run, later);
      const double fallen = kSteepness * (depth - path.radii[tip]);
      const double way = set.Between(path.points[root], path.points[tip]);
      const Coordinates along = set.Way(path.points[root], path.points[tip]);
      most = std::max(most, BeyondNoise(way - fallen, depth, along) / depth);
    }
  }
  return most;
}

double Significance::ValueOf(const ThinSet& set, const BranchPath& path, const Run& run) {
  const Coordinates along = set.Way(path.points[run.from], path.points[run.to]);
  const double radius = path.radii[run.from], out = BeyondNoise(run.elongation, radius, along);
  const double reach = std::min(kLongestRay, out / (kWidthShare * kLeastRatio) + 2 * radius + 4);
  Sections sections = SectionsAcross(path, run, reach);
  double value = BestRoot(set, path, run, sections);
  if (value >= kLeastFine) {
    for (Section& section : sections) {
      section.inscribed = section.radius;
      if (section.half_width <= kRoundness * section.radius + kRoundMargin) continue;
      TurnFinely(reach, section);
      if (section.half_width < kWallFlatness * section.radius + kWallMargin) continue;
      FollowWall(reach, section);
      FindInscribed(section);
    }
    value = BestRoot(set, path, run, sections);
  }
  return value;
}

// Extends the path beyond its end only if that may change the decision: it adds at most its length
// and the rise of its radius. The same holds for pits, which only make radii smaller.
Run Significance::RunOf(const ThinSet& set, BranchPath& path) {
  constexpr double kMost = TipExtender::kLongest + kSteepness * TipExtender::kLargestRise;
  const double way = set.Between(path.points[0], path.points.back());
  // A shorter branch leads to a face of a thin stack.
  if (way >= path.radii.back() && ExtendAcrossBorder(border_, scale_, path)) {
    return LargestRun(set, path, noise_);
  }
  const Run run = LargestRun(set, path, noise_);
  if (run.ratio > kSureRatio) return run;
  if (firm_depth_.has_value() && run.ratio >= kLeastRatio) {
    LookPastPits(path);
    return LargestRun(set, path, noise_);
  }
  if (!extender_.has_value()) return run;
  SurfaceNoise less = noise_;
  less.thin -= kMost;
  less.thick -= kMost;
  if (LargestRun(set, path, less).ratio < kLeastRatio) return run;
  extender_->Append(path);
  return LargestRun(set, path, noise_);
}

// Replaces radii by those without pits, in proportion to the roughness of the surface.
void Significance::LookPastPits(BranchPath& path) {
  for (size_t n = 0; n < path.points.size(); ++n) {
    const double deeper = firm_depth_->At(path.points[n]) - path.radii[n];
    path.radii[n] += static_cast<float>(noise_.roughness * deeper);
  }
}

// The value of the run with the root that gives the largest one.
double Significance::BestRoot(const ThinSet& set, const BranchPath& path, const Run& run,
                              const Sections& sections) const {
  // By how much the object is wider than the radius.
  std::array<double, kPlaces> wider;
  std::ranges::transform(sections, wider.begin(), [](const Section& section) {
    return std::max(section.half_width - section.radius, 0.0);
  });
  const double half_width_near_tip = wider[kNearTip] + sections[kNearTip].radius;
  const size_t first_own = FirstOwnPlace(set, path, run);
  double value = -std::numeric_limits<double>::infinity();
  for (size_t place = 0; place < kRoots; ++place) {
    const LatticePoint root = path.points[PlaceIn(run, place)];
    const Section& from = sections[place];
    const double wide = MedianFrom(wider, std::max(place, first_own));
    const double width = from.radius + kWidthShare * wide;
    for (size_t tip = place + 1; tip < kPlaces; ++tip) {
      const Section& to = sections[tip];
      const double narrower = from.inscribed == 0
                                  ? from.radius + wide - half_width_near_tip
                                  : kWallSteepness * (from.inscribed - to.inscribed);
      const double fallen = std::max(kSteepness * (from.radius - to.radius), narrower);
      const LatticePoint end = path.points[PlaceIn(run, tip)];
      const double out = set.Between(root, end) - fallen;
      value = std::max(value, BeyondNoise(out, from.radius, set.Way(root, end)) / width);
    }
  }
  return value;
}

// Skips points near the junction, where other branches are always near.
double Significance::UncoveredShare(const ThinSet& set, const FreeBranch& branch, const Run& run) {
  if (!balls_.has_value()) balls_.emplace(set, scale_);
  balls_->SetOwn(branch.points);
  const size_t stride = (run.to - run.from) / kCoverSamples + 1;
  const size_t last = std::min(run.to, branch.points.size());
  size_t covered = 0, samples = 0;
  for (size_t n = std::max<size_t>(run.from, 1); n <= last; n += stride, ++samples) {
    const LatticePoint p = branch.points[branch.points.size() - n];
    if (balls_->IsCovered(p, set.Between(p, *branch.junction), set)) ++covered;
  }
  return samples == 0 ? 1 : 1 - static_cast<double>(covered) / static_cast<double>(samples);
}

Significance::Sections Significance::SectionsAcross(const BranchPath& path, const Run& run,
                                                    double reach) {
  Sections sections;
  for (size_t place = 0; place < kPlaces; ++place) {
    const size_t n = PlaceIn(run, place);
    Section& section = sections[place];
    section = {PlaceOf(path.points[n], scale_), DirectionAt(path.points, n, scale_), path.radii[n]};
    const auto [u, v] = Across(section.way);
    section.side = u;
    for (const auto& [cosine, sine] : kTurns) {
      Widen(Sum(Sum({0, 0, 0}, cosine, u), sine, v), reach, section);
    }
  }
  return sections;
}

// Lines that do not lie in a thin plate soon leave it.
void Significance::TurnFinely(double reach, Section& section) {
  for (double turn = kFirstTurn; turn > kLeastTurn; turn /= 2) {
    const Coordinates from = section.side, across = Cross(section.way, from);
    if (Widen(Unit(Sum(from, turn, across)), reach, section)) continue;
    Widen(Unit(Sum(from, -turn, across)), reach, section);
  }
}

// Uses the mean of the line's two sides, since at a limb's end there is only one. Returns whether
// this line is the widest so far.
bool Significance::Widen(const Coordinates& side, double reach, Section& section) {
  const double start = std::floor(section.radius);
  const double there = WayOut(section.middle, side, start, reach);
  const double back = WayOut(section.middle, Sum({0, 0, 0}, -1, side), start, reach);
  const double half_width = (there + back) / 2;
  if (half_width <= section.half_width) return false;
  section.side = side;
  section.half_width = half_width;
  return true;
}

// Follows a bent wall, which a straight line soon leaves, to both sides of the widest line.
void Significance::FollowWall(double reach, Section& section) {
  const double there = WayInWall(FrontOf(section, section.side), section.radius, reach);
  const Front other = FrontOf(section, Sum({0, 0, 0}, -1, section.side));
  const double back = WayInWall(other, section.radius, reach);
  section.half_width = std::max(section.half_width, (there + back) / 2);
}

// Uses the third shortest of 16 lines: noise, or a bend met at a slant, may end a line early.
void Significance::FindInscribed(Section& section) {
  std::array<double, 3> least;
  least.fill(section.half_width);
  for (const auto& [cosine, sine] : kTurns) {
    const Coordinates way = Sum(Sum({0, 0, 0}, cosine, section.side), sine, section.way);
    for (const double side : {1.0, -1.0}) {
      const Front front = FrontOf(section, Sum({0, 0, 0}, side, way));
      least.back() = std::min(least.back(), WayInWall(front, section.radius, least.back()));
      std::ranges::sort(least);
    }
  }
  section.inscribed = std::max(least.back(), section.radius);
}

Significance::Front Significance::FrontOf(const Section& section, const Coordinates& way) {
  return {section.middle, way, Cross(section.way, section.side)};
}

double Significance::WayInWall(Front front, double radius, double reach) {
  double out = WayOut(front.middle, front.way, std::floor(radius), reach);
  while (front.length + out < reach && GoOnInWall(front, out, radius)) {
    out = WayOut(front.middle, front.way, 0, reach - front.length);
  }
  return std::min(front.length + out, reach);
}

// Where the line leaves its wall, continues in a wall that meets it there, or else from the middle
// of its own wall. Returns false at a rim and where there is no wall.
bool Significance::GoOnInWall(Front& front, double out, double radius) {
  if (out < kLeastOn * radius + 1) return false;
  const double back = std::min(out, radius);
  const double most = kMostThick * radius + 1;
  const Coordinates below = Sum({0, 0, 0}, -1, front.normal);
  const auto ways = [&](const Coordinates& at) {
    return std::array{WayOut(at, front.normal, 0, most), WayOut(at, below, 0, most)};
  };
  const Coordinates corner = Sum(front.middle, out - back, front.way);
  const auto [wall_above, wall_below] = ways(corner);
  if (std::max(wall_above, wall_below) >= most) {
    const Coordinates way = wall_above > wall_below ? front.normal : below;
    front = {Sum(corner, radius, way), way, front.way, front.length + out - back + radius};
    return true;
  }
  const Coordinates at = Sum(front.middle, out, front.way);
  const auto [thick_above, thick_below] = ways(at);
  const Coordinates middle = Sum(at, (thick_above - thick_below) / 2, front.normal);
  const Coordinates step = Sum(middle, -1, front.middle), way = Unit(step);
  const Coordinates normal = Unit(Sum(front.normal, -Dot(front.normal, way), way));
  front = {middle, way, normal, front.length + std::sqrt(Dot(step, step))};
  return true;
}

// How far the object extends, up to `reach`, in whole lattice units. Skips single missing points,
// which are noise. Needs: it extends to `start`, a whole number.
double Significance::WayOut(const Coordinates& from, const Coordinates& way, double start,
                            double reach) {
  double out = start;
  PointsAlong ahead;
  size_t passed = PointsAlong::kCount;  // of those ahead
  while (out < reach) {
    if (passed + 2 > PointsAlong::kCount) {
      ahead = FindPointsAlong(from, way, out + 1, 1, scale_);
      passed = 0;
    }
    const size_t steps = bricks_.Contains(ahead[passed]) ? 1 : 2;
    if (steps == 2 && !bricks_.Contains(ahead[passed + 1])) break;
    passed += steps;
    out += static_cast<double>(steps);
  }
  return out;
}

}  // namespace bccskel
