#include "core/pruning/significance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/pruning/collar.h"
#include "core/pruning/junction_ball.h"
#include "core/pruning/square_end.h"
#include "core/pruning/trunk.h"

namespace bccskel {
namespace {

constexpr double kWallSteepness = 0.4;  // weight of the inscribed circle's fall in a wall
constexpr double kWidthShare = 2.2;     // weight of half-width - radius
constexpr double kSureRatio = 2;        // above this, what lies beyond the end does not matter
constexpr double kLeastRatio = 0.2;     // below this, the branch is a bump whatever its width
constexpr double kLeastCorner = 0.4, kMostCorner = 0.95;  // of the corners of a strip
constexpr double kLeastFine = 0.35;                       // below this, a rough value suffices
constexpr size_t kRoots = 7;    // the limb may begin at one of the first seven places
constexpr size_t kNearTip = 9;  // a place near the tip
constexpr double kLongestRay = 400;
constexpr double kBulge = 1.2;  // least radius of a bulge at its end, in radii of the junction
constexpr size_t kCoverSamples = 16;
// On a rough surface, noise makes limbs beside trunks: there it is subtracted from lengths and not
// from their squares, in proportion to the roughness, from 1 / 25 on completely.
constexpr double kRoughShare = 25;

BranchPath PathOf(const ThinSet& set, const FreeBranch& branch) {
  BranchPath path{{*branch.junction}, {}};
  path.points.insert(path.points.end(), branch.points.rbegin(), branch.points.rend());
  for (LatticePoint p : path.points) path.radii.push_back(set.RadiusOf(p));
  return path;
}

// For a bulge, thicker than the limb that it sits on, the first place outside the ball at the
// junction: inside, lines across the branch run along that limb.
size_t FirstOwnPlace(const ThinSet& set, const BranchPath& path, const Run& run) {
  if (path.radii[run.to] < kBulge * path.radii[0]) return 0;
  return std::min(FirstPlaceOutside(set, path, run), Significance::kPlaces - 1);
}

// The median of the values from `place` on.
double MedianFrom(std::array<double, Significance::kPlaces> values, size_t place) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(place);
  const auto middle = first + (values.end() - first) / 2;
  std::nth_element(first, middle, values.end());
  return *middle;
}

constexpr double kNone = -std::numeric_limits<double>::infinity();

}  // namespace

Significance::Significance(const Volume& object, const SurfaceNoise& noise,
                           std::optional<TipExtender> extender, std::optional<FirmDepth> firm_depth,
                           const std::optional<LatticeBox>& border, const BorderCuts* cuts)
    : noise_(noise),
      scale_(AxisScaleOf(object.placement())),
      sections_(object),
      extender_(std::move(extender)),
      firm_depth_(std::move(firm_depth)),
      border_(border),
      cuts_(cuts) {}

double Significance::Of(const ThinSet& set, const FreeBranch& branch) {
  if (LeadsBesideCut(set, branch)) return kNone;
  Verdict* last = Known(branch);
  if (last == nullptr) last = &verdicts_.Set(branch.points[0], Look(set, branch));
  double value = last->value, beside_trunk = last->beside_trunk;
  if (std::max(value, beside_trunk) >= kLeastRatio) {
    const double uncovered = UncoveredShare(set, branch, last->run);
    if (value >= kLeastRatio) value *= uncovered;
    beside_trunk *= uncovered;
  }
  if (beside_trunk > std::max(value, kLeastRatio) && LeavesTrunk(set, branch, sections_)) {
    value = beside_trunk;
  }
  if (value >= kLeastCorner && value < kMostCorner &&
      LeadsIntoCornerOfStrip(set, branch, sections_)) {
    return kLeastCorner;
  }
  auto& known = last->is_arbitrary;
  if (value >= kLeastCorner && !known.has_value()) known = IsArbitrary(set, branch, sections_);
  if (value >= kLeastCorner && *known) return kLeastRatio;
  if (value >= kSureRatio || !MayHaveBodyEnds(set.RadiusOf(*branch.junction))) return value;
  return std::max(value, OfBodyEnd(set, branch, BodyAt::kJunction, value));
}

double Significance::BesideTrunk(const ThinSet& set, const BranchPath& path, const Run& run,
                                 double least) {
  const Coordinates along = set.Way(path.points[run.from], path.points[run.to]);
  const double root = path.radii[run.from], rough = std::min(kRoughShare * noise_.roughness, 1.0);
  const double simple =
      run.elongation - noise_.Stretch(along) * noise_.At(root) - SurfaceNoise::kMargin;
  const double out = (1 - rough) * noise_.Beyond(run.elongation, root, along) + rough * simple;
  if (out < std::max(least, kLeastRatio) * root) return 0;
  const auto wider = WidthBesideTrunk(set, path, run, sections_);
  return wider.has_value() ? out / (root + kWidthShare * *wider) : 0;
}

// Where the border cuts a flat limb off, branches lead into the corners of the cut.
bool Significance::LeadsBesideCut(const ThinSet& set, const FreeBranch& branch) const {
  if (cuts_ == nullptr) return false;
  const LatticePoint end = branch.points[0];
  const auto middle = cuts_->MiddleBeside(end, set.RadiusOf(end) + 1);
  return middle.has_value() && set.Contains(*middle) &&
         std::ranges::find(branch.points, *middle) == branch.points.end();
}

// A body that narrows falls short of a run: its radius falls twice as fast as along a limb. Limbs
// that leave it show that its end is not just a corner, of which several would meet.
double Significance::OfBodyEnd(const ThinSet& set, const FreeBranch& branch, BodyAt at,
                               double least) {
  const LatticePoint junction = *branch.junction;
  const double radius = set.RadiusOf(junction);
  const auto sticks_out = [&](LatticePoint p, double depth) {
    return set.Between(junction, p) + depth - radius;
  };
  double farthest = 0;
  for (LatticePoint p : branch.points) {
    farthest = std::max(farthest, sticks_out(p, set.RadiusOf(p)));
  }
  // The extension adds at most its length and the rise of its radius.
  constexpr double kMost = TipExtender::kLongest + TipExtender::kLargestRise;
  if (farthest + kMost <= std::max(least, kLeastRatio) * radius) return kNone;
  if (!IsBodyEnd(set, branch, at == BodyAt::kTurn)) return kNone;
  BranchPath path = PathOf(set, branch);
  if (extender_.has_value()) extender_->Append(path);
  LatticePoint tip = junction;
  farthest = 0;
  for (size_t n = 0; n < path.points.size(); ++n) {
    const double out = sticks_out(path.points[n], path.radii[n]);
    if (out > farthest) farthest = out, tip = path.points[n];
  }
  if (farthest == 0) return kNone;
  const double out = noise_.Beyond(farthest, radius, set.Way(junction, tip));
  if (out / radius <= least || branch.points.size() < 2) return kNone;  // one has no direction
  const size_t middle = branch.points.size() / 2;
  const LatticePoint p = branch.points[middle];
  const bool beside = at == BodyAt::kTurn && LeavesTrunk(set, branch, sections_);
  const Coordinates way = DirectionAt(branch.points, middle, scale_);
  const double wider =
      sections_.WiderAcross(PlaceOf(p, scale_), way, set.RadiusOf(p), kLongestRay, beside);
  const Run outer_half = {.from = middle, .to = branch.points.size()};
  return out / (radius + kWidthShare * wider) * UncoveredShare(set, branch, outer_half);
}

bool Significance::MayHaveBodyEnds(double radius, double least) const {
  return radius >= least * (noise_.At(radius) + SurfaceNoise::kMargin);
}

bool Significance::IsCovered(const ThinSet& set, std::span<const LatticePoint> path,
                             LatticePoint next, double radius) {
  if (!balls_.has_value()) balls_.emplace(set);
  balls_->SetOwn(path);
  return balls_->IsCovered(next, radius, set.Between(next, path.front()), set);
}

double Significance::OfPath(const ThinSet& set, std::array<BranchPath, 2> ways) const {
  double elongation = 0;
  for (BranchPath& way : ways) {
    ExtendAcrossBorder(border_, scale_, way);
    elongation += LargestElongation(set, way);
  }
  return (elongation - noise_.step) / ways[0].radii[0];
}

std::vector<double> Significance::OfAll(const ThinSet& set, std::span<const FreeBranch> branches,
                                        const exec::Context& context) {
  std::vector<double> values(branches.size(), kNone);
  if (!balls_.has_value()) balls_.emplace(set, context);
  const int workers = context.WorkersFor(branches.size(), kWork);
  if (workers == 1) {
    for (size_t n = 0; n < branches.size() && !context.ShouldStop(); ++n) {
      values[n] = Of(set, branches[n]);
    }
    return values;
  }
  std::vector<std::optional<Verdict>> verdicts(branches.size());
  (void)context.ForEach(workers, branches.size(), 1, [&](int) {
    return [&, own = *this](size_t n) mutable {
      values[n] = own.Of(set, branches[n]);
      if (const Verdict* found = own.Known(branches[n]); found != nullptr) verdicts[n] = *found;
    };
  });
  for (size_t n = 0; n < branches.size(); ++n) {
    if (verdicts[n].has_value()) verdicts_.Set(branches[n].points[0], *verdicts[n]);
  }
  return values;
}

Significance::Verdict* Significance::Known(const FreeBranch& branch) {
  Verdict* last = verdicts_.Find(branch.points[0]);
  if (last == nullptr || last->junction != *branch.junction) return nullptr;
  return last->points == branch.points.size() ? last : nullptr;
}

// The largest run may begin in something wide and reach the limb late, so the run of its later half
// is evaluated, too, then that of the later half of this one, and so on. It may also lie in a bump
// at the end of a thick limb, such as an ear of a head, so the largest run before it is evaluated,
// and so on.
Significance::Verdict Significance::Look(const ThinSet& set, const FreeBranch& branch) {
  BranchPath path = PathOf(set, branch);
  Verdict best{*branch.junction, branch.points.size(), RunOf(set, path)};
  const Run largest = best.run;
  best.value = largest.ratio;
  if (largest.ratio < kLeastRatio) return best;
  best.value = ValueOf(set, path, largest);
  if (best.value < kSureRatio) best.beside_trunk = BesideTrunk(set, path, largest, best.value);
  size_t first = PlaceIn(largest, kPlaces / 2);
  while (first + kPlaces <= path.points.size()) {
    const Run run = LargestRun(set, path, noise_, first);
    if (run.ratio < kLeastRatio) break;
    Consider(set, path, run, best);
    const size_t later = PlaceIn(run, kPlaces / 2);
    if (later == first) break;
    first = later;
  }
  size_t last = largest.from;
  while (last + 1 >= kPlaces) {
    path.points.resize(last + 1);
    path.radii.resize(last + 1);
    const Run run = LargestRun(set, path, noise_);
    if (run.ratio < kLeastRatio) break;
    Consider(set, path, run, best);
    last = run.from;
  }
  return best;
}

void Significance::Consider(const ThinSet& set, const BranchPath& path, const Run& run,
                            Verdict& best) {
  if (ValueAtMost(set, path, run) <= best.value) return;
  const double value = ValueOf(set, path, run, best.value);
  if (value > best.value) best.run = run, best.value = value;
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
      most = std::max(most, noise_.Beyond(way - fallen, depth, along) / depth);
    }
  }
  return most;
}

// Refining makes no section narrower, so the bounds hold. It stops when they show that the branch
// is spurious, as most branches of a plate are. Circles in walls are inscribed only where they may
// decide.
double Significance::ValueOf(const ThinSet& set, const BranchPath& path, const Run& run,
                             double least) {
  const Coordinates along = set.Way(path.points[run.from], path.points[run.to]);
  const double radius = path.radii[run.from], out = noise_.Beyond(run.elongation, radius, along);
  const double reach = std::min(kLongestRay, out / (kWidthShare * kLeastRatio) + 2 * radius + 4);
  Sections sections = SectionsAcross(path, run, reach);
  const double width_near_tip = sections[kNearTip].radius + sections[kNearTip].WiderThanThick();
  std::vector<Part> parts = PartsOf(set, path, run);
  const size_t first_own = FirstOwnPlace(set, path, run);
  double most = Bound(parts, sections, first_own);
  const double rough = RoughValueOf(parts, sections, width_near_tip);
  if (rough < kLeastFine || most <= least) return rough;
  bool wider = false;  // since the last bound
  for (size_t place = kPlaces; place-- > 0;) {
    wider = sections_.Refine(reach, sections[place]) || wider;
    if (place > kPlaces / 2) continue;  // most medians hardly change before
    if (std::exchange(wider, false)) most = Bound(parts, sections, first_own);
    if (most <= std::max(least, kLeastFine)) return RoughValueOf(parts, sections, width_near_tip);
  }
  std::ranges::sort(parts, std::greater<>(), &Part::bound);
  double value = least;
  for (const Part& part : parts) {
    if (part.bound <= value) break;
    const double at_root = sections_.Inscribed(sections[part.root]);
    const double narrower = kWallSteepness * (at_root - sections_.Inscribed(sections[part.tip]));
    value = std::max(value, ValueOf(part, sections, narrower));
  }
  return value;
}

// The width near the tip stands in for the walls.
double Significance::RoughValueOf(const std::vector<Part>& parts, const Sections& sections,
                                  double width_near_tip) const {
  double value = -std::numeric_limits<double>::infinity();
  for (const Part& part : parts) {
    const double narrower = sections[part.root].radius + part.wider - width_near_tip;
    value = std::max(value, ValueOf(part, sections, narrower));
  }
  return value;
}

std::vector<Significance::Part> Significance::PartsOf(const ThinSet& set, const BranchPath& path,
                                                      const Run& run) {
  std::vector<Part> parts;
  for (size_t root = 0; root < kRoots; ++root) {
    const LatticePoint from = path.points[PlaceIn(run, root)];
    for (size_t tip = root + 1; tip < kPlaces; ++tip) {
      const LatticePoint to = path.points[PlaceIn(run, tip)];
      parts.push_back({root, tip, set.Way(from, to), set.Between(from, to), 0, 0});
    }
  }
  return parts;
}

double Significance::Bound(std::vector<Part>& parts, const Sections& sections,
                           size_t first_own) const {
  std::array<double, kPlaces> wider;
  std::ranges::transform(sections, wider.begin(), &CrossSection::WiderThanThick);
  std::array<double, kRoots> medians;
  for (size_t root = 0; root < kRoots; ++root) {
    medians[root] = MedianFrom(wider, std::max(root, first_own));
  }
  double most = kNone;
  for (Part& part : parts) {
    part.wider = medians[part.root];
    part.bound = ValueOf(part, sections, kNone);
    most = std::max(most, part.bound);
  }
  return most;
}

double Significance::ValueOf(const Part& part, const Sections& sections, double narrower) const {
  const CrossSection& root = sections[part.root];
  const double fallen = std::max(kSteepness * (root.radius - sections[part.tip].radius), narrower);
  const double out = part.length - fallen;
  return noise_.Beyond(out, root.radius, part.way) / (root.radius + kWidthShare * part.wider);
}

// Beyond sheets, extends the path only if that may change the decision: it adds at most its length
// and the rise of its radius. The same holds for pits, which only make radii smaller.
Run Significance::RunOf(const ThinSet& set, BranchPath& path) {
  constexpr double kMost = TipExtender::kLongest + kSteepness * TipExtender::kLargestRise;
  const double way = set.Between(path.points[0], path.points.back());
  // A shorter branch leads to a face of a thin stack.
  if (way >= path.radii.back() && ExtendAcrossBorder(border_, scale_, path)) {
    return LargestRun(set, path, noise_);
  }
  if (extender_.has_value()) extender_->AppendOverSheet(path);
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

// Skips points near the junction, where other branches are always near.
double Significance::UncoveredShare(const ThinSet& set, const FreeBranch& branch, const Run& run) {
  if (!balls_.has_value()) balls_.emplace(set);
  balls_->SetOwn(branch.points);
  const size_t stride = (run.to - run.from) / kCoverSamples + 1;
  const size_t last = std::min(run.to, branch.points.size());
  size_t covered = 0, samples = 0;
  for (size_t n = std::max<size_t>(run.from, 1); n <= last; n += stride, ++samples) {
    const LatticePoint p = branch.points[branch.points.size() - n];
    const double way = set.Between(p, *branch.junction);
    if (balls_->IsCovered(p, set.RadiusOf(p), way, set)) ++covered;
  }
  return samples == 0 ? 1 : 1 - static_cast<double>(covered) / static_cast<double>(samples);
}

Significance::Sections Significance::SectionsAcross(const BranchPath& path, const Run& run,
                                                    double reach) {
  Sections sections;
  for (size_t place = 0; place < kPlaces; ++place) {
    const size_t n = PlaceIn(run, place);
    sections[place] = sections_.Across(PlaceOf(path.points[n], scale_),
                                       DirectionAt(path.points, n, scale_), path.radii[n], reach);
  }
  return sections;
}

}  // namespace bccskel
