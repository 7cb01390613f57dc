#include "core/pruning/turned_tips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/distance/places.h"

namespace bccskel {
namespace {

constexpr double kStraightOn = 0.77;  // cosine of 40 degrees
constexpr double kLongest = 1.6;      // in radii of the fork, of tips in caps
constexpr double kShortest = 1.2;     // the same of ribs
constexpr double kBack = -0.1;        // cosine of 96 degrees, for ribs
constexpr double kLimbRadii = 2;      // least length of the limb, in radii of the fork
constexpr double kLimbWorth = 2;      // least worth of a free limb, in worths of the other arm
// In radii: half-widths across a disc's rib and across its shaft, so far before the disc.
constexpr double kWide = 1.8, kRound = 1.5, kBeforeDisc = 3;
constexpr double kTwin = 1.15;  // largest worth of a tip that turns aside, in thresholds

// The direction of the limb over its last two radii before the fork; none if it is shorter.
std::optional<Coordinates> WayOfLimb(const ThinSet& set, const Arm& limb, LatticePoint fork) {
  const double far = kLimbRadii * set.RadiusOf(fork);
  for (LatticePoint p : limb.points) {
    if (set.Between(p, fork) >= far) return set.Way(p, fork);
  }
  return std::nullopt;
}

// The arm as a tip that turns away from the limb, without its worth; none if it does not.
std::optional<TurnedTips::Tip> TipAside(const ThinSet& set, const Arm& aside, const Arm& limb) {
  const std::optional<Coordinates> in = WayOfLimb(set, limb, aside.fork);
  if (!in.has_value()) return std::nullopt;
  const Coordinates out = set.Way(aside.fork, aside.points.back());
  const double length = LengthOf(out), radius = set.RadiusOf(aside.fork);
  const double cosine = Dot(*in, out) / (LengthOf(*in) * length);
  if (cosine >= kStraightOn) return std::nullopt;
  TurnedTips::Tip tip = {{aside.points.rbegin(), aside.points.rend()}};
  tip.in_cap = cosine > 0 && length <= kLongest * radius;
  tip.is_rib = cosine > kBack && length > kShortest * radius &&
               set.Between(aside.fork, limb.points.back()) >= length;
  return tip.in_cap || tip.is_rib ? std::optional(std::move(tip)) : std::nullopt;
}

// The half-width across a direction, in radii.
double WidthAt(LatticePoint p, const Coordinates& way, const ThinSet& set,
               CrossSections& sections) {
  const double radius = set.RadiusOf(p), reach = 2 * kWide * radius;
  CrossSection section = sections.Across(PlaceOf(p, set.scale()), Unit(way), radius, reach);
  sections.Refine(reach, section);
  return section.half_width / radius;
}

}  // namespace

void TurnedTips::Note(const ThinSet& set, const FreeBranch& going,
                      std::span<const LatticePoint> cluster, const WorthOf& worth_of) {
  std::vector<Arm> arms = ArmsOf(set, cluster);
  if (arms.size() != 3) return;
  std::erase_if(arms, [&](const Arm& arm) { return arm.points.back() == going.points[0]; });
  if (arms.size() != 2 || (!arms[0].is_free && !arms[1].is_free)) return;
  std::array<std::optional<Tip>, 2> tips;
  for (size_t n = 0; n < 2; ++n) {
    if (arms[n].is_free) tips[n] = TipAside(set, arms[n], arms[1 - n]);
  }
  // Worths take longer.
  if (!tips[0].has_value() && !tips[1].has_value()) return;
  std::array<double, 2> worths = {};  // of those that are free
  for (size_t n = 0; n < 2; ++n) {
    const Arm& arm = arms[n];
    if (arm.is_free) worths[n] = worth_of({{arm.points.rbegin(), arm.points.rend()}, arm.fork});
  }
  const size_t less = !arms[0].is_free || (arms[1].is_free && worths[1] < worths[0]) ? 1 : 0;
  if (!tips[less].has_value()) return;
  if (arms[1 - less].is_free && worths[1 - less] < kLimbWorth * worths[less]) return;
  tips[less]->worth = worths[less];
  tips_[arms[less].points.back()].push_back(*std::move(tips[less]));
}

void TurnedTips::DropFrom(double threshold) {
  for (auto& [end, tips] : tips_) {
    for (Tip& tip : tips) {
      tip.in_cap = tip.in_cap && tip.worth < kTwin * threshold;
      tip.is_rib = tip.is_rib && tip.worth < threshold;
    }
    std::erase_if(tips, [](const Tip& tip) { return !tip.in_cap && !tip.is_rib; });
  }
}

const TurnedTips::Tip* TurnedTips::At(std::span<const LatticePoint> branch) const {
  const auto found = tips_.find(branch.front());
  if (found == tips_.end()) return nullptr;
  const Tip* longest = nullptr;
  for (const Tip& tip : found->second) {
    const size_t size = tip.points.size();
    const bool fits =
        size + 1 < branch.size() && (longest == nullptr || size > longest->points.size());
    if (fits && std::ranges::equal(tip.points, branch.first(size))) longest = &tip;
  }
  return longest;
}

bool LiesInDisc(std::span<const LatticePoint> rib, std::span<const LatticePoint> branch,
                const ThinSet& set, CrossSections& sections, const SurfaceNoise& noise) {
  const auto limb = branch.subspan(rib.size());  // from the fork
  const double radius = set.RadiusOf(limb[0]);
  if (set.Between(limb[0], rib[0]) < radius + noise.At(radius)) return false;
  const auto before = std::ranges::find_if(
      limb, [&](LatticePoint p) { return set.Between(p, limb[0]) >= kBeforeDisc * radius; });
  return before != limb.end() &&
         WidthAt(*before, set.Way(*before, limb[0]), set, sections) <= kRound &&
         WidthAt(rib[rib.size() / 2], set.Way(limb[0], rib[0]), set, sections) >= kWide;
}

}  // namespace bccskel
