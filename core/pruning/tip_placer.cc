#include "core/pruning/tip_placer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/pruning/grow_along.h"
#include "core/pruning/largest_run.h"

namespace bccskel {
namespace {

constexpr double kGainBySteps = 0.42;  // a tip farther out must be better by so many surface steps
constexpr double kGainByNoise = 0.06;  // plus this share of the noise allowance; less may be noise
constexpr double kAimRadii = 1.75;     // like kCutRadii, for the point that shows the direction
// A tip in the ball of the junction: the least radius, in that of the junction, and how far the end
// may reach beyond the middle of its ball, in its depth.
constexpr double kOfBody = 0.85, kHolds = 1.2;
constexpr double kBumpLength = 6;    // longest bumps in lattice units; longer ones are thin limbs
constexpr double kBumpRadii = 2;     // the same in radii of the limb
constexpr double kGrowthRadii = 2;   // longest growth, in radii of the limb's root
constexpr double kGrowthMargin = 6;  // plus lattice units
constexpr double kLongStep = 2;      // from this step on by one radius only: caps are too coarse
constexpr double kOffArc = 0.25;     // largest distance of points from a limb's arc, in its height
constexpr double kOffArcAtRoot = kOffArc / 2;  // the same where the arc begins at the root
constexpr double kLimbAfterFlat = 0.95;        // least significance; corners of strips reach 0.9
constexpr double kPointed = 0.7;  // largest radius at the end of a pointed limb, in its root's
// Of limbs that narrow to a point: the largest half-width in radii (across the curve into the
// corner of a cube it is 1.5 radii) plus surface steps, and the least depth at which they are
// compared, in lattice units plus surface steps.
constexpr double kRoundRadii = 1.3, kRoundSteps = 0.5, kLeastRound = 4, kLeastRoundSteps = 2;
constexpr double kLongerThanCap = 1.3;  // in the depth where they begin to narrow
constexpr double kStraight = 0.98, kStraightIfRough = 0.92;  // cosines of 11 and 23 degrees
constexpr size_t kRoundPlaces = 8, kLeastRoundPlaces = 3, kMostWidePlaces = 1;
// Of a path into a corner, in the depth where it leaves the straight part: how far the ball at its
// end reaches from there (sqrt(5) for three equal sides), and the depth at its end.
constexpr double kCornerReach = 2.4, kIntoCorner = 0.85;
constexpr size_t kChord = 4;  // points; shorter ones are steps of the lattice

}  // namespace

TipPlacer::TipPlacer(ThinSet& set, const TipTask& task, TipDepths& depths)
    : set_(set),
      bricks_(task.in.object),
      bumps_(bricks_),
      radius_(task.in.radius),
      depth_(depths.firm),
      steps_(set, task.in.object, depths.firm),
      sections_(task.in.object),
      flat_(task.in.object, depths.searching, depths.firm),  // it ends at the border
      last_limb_(task.in.object, task.noise, task.balls),
      keep_(task.keep),
      turned_(task.turned),
      balls_(task.balls),
      scale_(AxisScaleOf(task.in.object.placement())),
      step_(std::ranges::max(scale_)),
      least_gain_(kGainBySteps * task.noise.step + kGainByNoise * task.noise.thin),
      noise_(task.noise) {
  if (task.in.image.has_value()) border_tips_.emplace(task.in.object, *task.in.image);
}

void TipPlacer::Place(LatticePoint end) {
  if (!set_.Contains(end) || !set_.IsEnd(end)) return;
  last_limb_.Forget();
  FreeBranch branch = BranchFrom(set_, end);
  FindRoot(branch);
  if (LeadToBorder(branch)) return;
  CutTurned(branch, &TurnedTips::Tip::is_rib);
  if (CutFlat(branch)) return;
  CutTurned(branch, &TurnedTips::Tip::in_cap);
  anchor_ = TakeAnchor(set_, branch);
  if (branch.points.empty()) return;
  path_.assign(branch.points.rbegin(), branch.points.rend());
  CutBumps();
  origin_ = anchor_;
  way_on_ = {};
  direction_ = Unit(set_.Way(anchor_, AimFrom(FirstCut(kAimRadii))));
  const size_t first = FirstCut(kCutRadii);
  CutAfter(SafestFrom(GrowAnew(first)));
  MeasureGrown();
}

PointsByAxis TipPlacer::TakeAtBorder() { return std::exchange(at_border_, {}); }

void TipPlacer::FindRoot(const FreeBranch& branch) {
  BranchPath path{{branch.points.rbegin(), branch.points.rend()}, {}};
  std::vector<LatticePoint>& points = path.points;
  junction_ = branch.junction;
  own_ = points;
  limb_radius_ = MedianOf(RadiiOf(own_));
  if (junction_.has_value()) {
    points.insert(points.begin(), *junction_);
  } else {
    points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2));
  }
  path.radii = RadiiOf(points);
  root_ = points[0];
  if (points.size() >= 2) {
    const Run run = LargestRun(set_, path, noise_);
    if (run.ratio >= kDefaultSignificance) root_ = points[run.from];
  }
  root_radius_ = set_.RadiusOf(root_);
}

std::vector<float> TipPlacer::RadiiOf(std::span<const LatticePoint> points) const {
  std::vector<float> radii;
  for (LatticePoint p : points) radii.push_back(set_.RadiusOf(p));
  return radii;
}

void TipPlacer::CutTurned(FreeBranch& branch, bool TurnedTips::Tip::*kind) {
  const TurnedTips::Tip* turned = turned_.At(branch.points);
  if (turned == nullptr || !(turned->*kind)) return;
  const auto is_kept = [&](LatticePoint p) { return keep_.contains(p); };
  if (std::ranges::any_of(turned->points, is_kept)) return;
  if (kind == &TurnedTips::Tip::is_rib &&
      !LiesInDisc(turned->points, branch.points, set_, sections_, noise_))
    return;
  for (LatticePoint p : turned->points) set_.Remove(p);
  branch = BranchFrom(set_, branch.points[turned->points.size()]);
  FindRoot(branch);
}

bool TipPlacer::LeadToBorder(const FreeBranch& branch) {
  if (!border_tips_.has_value()) return false;
  path_.assign(branch.points.rbegin(), branch.points.rend());
  const std::optional<BorderTips::Way> way = border_tips_->WayOf(path_, junction_, set_);
  if (!way.has_value() || !GrowFrom(way->from, way->places)) return false;
  std::ranges::copy(std::span(path_).subspan(way->from + 1),
                    std::back_inserter(at_border_[way->axis]));
  MeasureGrown();
  return true;
}

bool TipPlacer::CutFlat(const FreeBranch& branch) {
  path_.assign(branch.points.rbegin(), branch.points.rend());
  // The middle of a path with two ends may lie so near an end that it does not show the way there.
  const auto eighth = path_.begin() + static_cast<std::ptrdiff_t>(path_.size() / 8);
  const auto root = junction_.has_value() ? std::ranges::find(path_, root_) : eighth;
  if (root != path_.end()) path_.erase(path_.begin(), root);
  const std::optional<FlatEnd::Tip> tip = flat_.In(path_, set_);
  if (!tip.has_value() || (!tip->middle.empty() && IsLimbAfter(NearestTo(tip->middle.back())))) {
    return false;
  }
  if (tip->middle.size() < 2 || !GrowFrom(tip->from, tip->middle)) {
    if (IsLimbAfter(tip->last)) return false;
    CutAfter(tip->last);
  }
  MeasureGrown();
  return true;
}

bool TipPlacer::IsLimbAfter(size_t position) {
  const auto after = std::span(path_).subspan(position);
  return after.size() > 1 && last_limb_.SignificanceOf(set_, after) >= kLimbAfterFlat;
}

size_t TipPlacer::NearestTo(const Coordinates& place) const {
  const auto square = [&](LatticePoint p) {
    const Coordinates way = Sum(PlaceOf(p, scale_), -1, place);
    return Dot(way, way);
  };
  return static_cast<size_t>(std::ranges::min_element(path_, {}, square) - path_.begin());
}

bool TipPlacer::GrowFrom(size_t from, std::span<const Coordinates> places) {
  const auto behind = std::span(path_).subspan(from + 1);
  const auto is_kept = [&](LatticePoint p) { return keep_.contains(p); };
  if (std::ranges::any_of(behind, is_kept)) return false;
  balls_.SetOwn(own_);
  const auto may_add = [&](LatticePoint p) { return bricks_.Contains(p) && !IsInBallOfAnother(p); };
  return GrowAlong(places, from, may_add, path_, set_);
}

double TipPlacer::Along(LatticePoint p) const { return Dot(direction_, set_.Way(origin_, p)); }

double TipPlacer::Aside(LatticePoint p) const { return way_on_.Aside(set_.Way(ridge_end_, p)); }

double TipPlacer::Merit(LatticePoint p, double slope) {
  return slope * Along(p) - Aside(p) + depth_.At(p);
}

double TipPlacer::MeritAtMost(LatticePoint p, double slope) const {
  return slope * Along(p) - Aside(p) + depth_.AtMost(p);
}

size_t TipPlacer::BestFrom(size_t first, double slope) {
  size_t best = path_.size() - 1;
  double most = Merit(path_[best], slope);
  for (size_t n = best; n-- > first;) {
    if (MeritAtMost(path_[n], slope) <= most || Merit(path_[n], slope) <= most) continue;
    best = n;
    most = Merit(path_[n], slope);
  }
  return best;
}

size_t TipPlacer::SafestFrom(size_t first) {
  const double enough = Merit(path_[BestFrom(first)]) - least_gain_;
  while (MeritAtMost(path_[first]) < enough || Merit(path_[first]) < enough) ++first;
  return first;
}

void TipPlacer::CutAfter(size_t last) {
  while (path_.size() > last + 1 && !keep_.contains(path_.back())) {
    set_.Remove(path_.back());
    path_.pop_back();
  }
}

LatticePoint TipPlacer::AimFrom(size_t first) {
  const double least = kLeastAim * step_;
  if (set_.Between(anchor_, path_[first]) >= least) return path_[first];
  LatticePoint aim = path_.back();
  double most = 0;
  for (size_t n = first; n < path_.size(); ++n) {
    const double way = set_.Between(anchor_, path_[n]);
    const double merit = kRidgeSlope * way + set_.RadiusOf(path_[n]);
    if (way < least || merit <= most) continue;
    most = merit;
    aim = path_[n];
  }
  return aim;
}

bool TipPlacer::HasPoint() const {
  return noise_.roughness == 0 && set_.RadiusOf(path_.back()) < kPointed * root_radius_;
}

void TipPlacer::CutBumps() {
  bumps_.SetLimb(path_, HasPoint());
  const size_t last = bumps_.LastFirm(path_);
  const double length = set_.Between(path_[last], path_.back());
  const double longest = std::min<double>(kBumpLength, kBumpRadii * MedianOf(RadiiOf(path_)));
  if (bumps_.IsFirm(path_[last]) && length <= longest) CutAfter(last);
}

size_t TipPlacer::FirstCut(double radii) {
  size_t first = path_.size() - 1;
  for (size_t n = first; n > 0 && path_[n] != root_; --n) {
    if (IsInCapOf(path_[n - 1], radii)) first = n - 1;
  }
  return last_limb_.BeginIn(set_, path_, first);
}

bool TipPlacer::IsInJunction(LatticePoint p) const {
  return junction_.has_value() && set_.Between(*junction_, p) < set_.RadiusOf(*junction_);
}

bool TipPlacer::IsInCapOf(LatticePoint p, double radii) {
  const double way = set_.Between(path_.back(), p);
  if (IsInJunction(p)) {
    return set_.RadiusOf(p) >= kOfBody * set_.RadiusOf(*junction_) &&
           way + set_.RadiusOf(path_.back()) < kHolds * depth_.At(p);
  }
  return way <= radii * set_.RadiusOf(p) + kCutMargin || way <= radii * depth_.At(p) + kCutMargin;
}

size_t TipPlacer::FirstThatShowsWay(size_t n) const {
  const double least = kLeastWayRadii * set_.RadiusOf(path_[n]);
  while (n + 1 < path_.size() && set_.Between(anchor_, path_[n]) < least) ++n;
  return n;
}

size_t TipPlacer::GrowAnew(size_t first) {
  const size_t straight = FirstThatShowsWay(BestFrom(first, kRidgeSlope));
  std::optional<size_t> turned = PointedEnd(first, straight);
  if (!bumps_.IsFirm(path_.back())) return turned.value_or(first);
  if (!turned.has_value()) {
    turned = RidgeEndAside(set_, depth_, {path_, first, path_[straight], limb_radius_});
    if (turned.has_value() && MayLeadIntoCorner(straight, *turned)) turned.reset();
  }
  CutAfter(turned.value_or(straight));
  first = turned.value_or(first);
  ridge_end_ = path_.back();
  WayOn on = WayOnFrom(set_, anchor_, path_);
  if (FollowBend()) on.way = direction_;
  Extend();
  const double corner = kCornerRadii * set_.RadiusOf(ridge_end_) + kCutMargin;
  if (set_.Between(ridge_end_, path_.back()) <= corner) way_on_ = on;
  return first;
}

std::optional<size_t> TipPlacer::PointedEnd(size_t first, size_t straight) {
  const size_t end = path_.size() - 1;
  size_t best = first;
  double length = 0, most = depth_.At(path_[first]);
  for (size_t from = first; from < end; from += kChord) {
    const size_t n = std::min(from + kChord, end);
    length += set_.Between(path_[from], path_[n]);
    const double merit = kTipSlope * length + depth_.At(path_[n]);
    if (merit < most) continue;
    best = n;
    most = merit;
  }
  if (best <= straight ||
      set_.Between(path_[straight], path_[best]) <= kLongerThanCap * depth_.At(path_[straight])) {
    return std::nullopt;
  }
  const Coordinates in = set_.Way(anchor_, path_[straight]);
  const Coordinates out = set_.Way(path_[straight], path_[best]);
  const double straight_on = noise_.roughness == 1 ? kStraightIfRough : kStraight;
  if (Dot(in, out) > straight_on * LengthOf(in) * LengthOf(out)) return std::nullopt;
  return IsRoundBetween(straight, best) ? std::optional(best) : std::nullopt;
}

bool TipPlacer::MayLeadIntoCorner(size_t straight, size_t end) {
  const double from = depth_.At(path_[straight]), to = depth_.At(path_[end]);
  const double reach = set_.Between(path_[straight], path_[end]) + to;
  return to <= kIntoCorner * from && reach <= kCornerReach * from && !IsRoundBetween(straight, end);
}

bool TipPlacer::IsRoundBetween(size_t first, size_t last) {
  size_t round = 0, wide = 0;
  for (size_t k = 1; k <= kRoundPlaces; ++k) {
    const size_t n = first + (last - first) * k / kRoundPlaces;
    if (depth_.At(path_[n]) < kLeastRound + kLeastRoundSteps * noise_.step) continue;
    ++(IsRoundAt(n) ? round : wide);
  }
  return round >= kLeastRoundPlaces && wide <= kMostWidePlaces;
}

bool TipPlacer::IsRoundAt(size_t n) {
  const double depth = depth_.At(path_[n]);
  size_t before = n, after = n;
  while (before > 0 && set_.Between(path_[before], path_[n]) < depth) --before;
  while (after + 1 < path_.size() && set_.Between(path_[n], path_[after]) < depth) ++after;
  const Coordinates way = Unit(set_.Way(path_[before], path_[after]));
  const double most = kRoundRadii * depth + kRoundSteps * noise_.step;
  return sections_.Across(PlaceOf(path_[n], scale_), way, depth, 2 * most).half_width <= most;
}

bool TipPlacer::FollowBend() {
  std::vector<LatticePoint> limb = {anchor_};
  limb.insert(limb.end(), path_.begin(), path_.end());
  const auto root = std::ranges::find(limb, root_);
  const double most_off = root == limb.end() ? kOffArc : kOffArcAtRoot;
  if (root != limb.end()) limb.erase(limb.begin(), root);
  const std::optional<Coordinates> bent =
      DirectionOnArc(set_, limb, set_.RadiusOf(limb.back()), most_off);
  if (!bent.has_value()) return false;
  origin_ = limb.back();
  direction_ = *bent;
  return true;
}

void TipPlacer::Extend() {
  balls_.SetOwn(own_);
  double best = Merit(path_.back());
  const LatticePoint start = path_.back();
  const double radii = step_ < kLongStep ? kGrowthRadii : 1;
  const double longest = radii * root_radius_ + kGrowthMargin;
  while (const std::optional<LatticePoint> next = steps_.Next(path_, anchor_)) {
    if (!bumps_.IsFirm(*next) || set_.Between(*next, start) > longest || IsInBallOfAnother(*next))
      break;
    Append(*next);
    const double merit = Merit(*next);
    if (merit < best - kTipPatience) break;
    best = std::max(best, merit);
  }
}

bool TipPlacer::IsInBallOfAnother(LatticePoint p) const {
  return junction_.has_value() &&
         balls_.IsCovered(p, depth_.At(p), set_.Between(p, *junction_), set_);
}

void TipPlacer::Append(LatticePoint p) {
  set_.Add(p, 0);
  path_.push_back(p);
}

void TipPlacer::MeasureGrown() {
  for (size_t n = path_.size(); n > 0 && set_.RadiusOf(path_[n - 1]) == 0; --n) {
    set_.SetRadius(path_[n - 1], radius_.At(path_[n - 1]));
  }
}

}  // namespace bccskel
