#include "core/pruning/sheet_pruner.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/exec/stop_poll.h"
#include "core/pruning/sheet_burning.h"
#include "core/pruning/simple_points.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

constexpr double kTwigSlope = 0.5;

// What is worth less than the margin, in the order in which it burned, each point once it is
// simple.
void RemoveInTurn(ThinSet& set, const SheetBurning& burning, double margin,
                  const exec::Context& context) {
  StopPoll poll(context);
  PointTable<size_t> place;
  std::set<std::pair<size_t, LatticePoint>> turns;
  for (size_t n = 0; n < burning.burned().size(); ++n) {
    const LatticePoint p = burning.burned()[n];
    if (burning.WorthOf(p) >= margin) continue;
    place.Set(p, n);
    turns.emplace(n, p);
  }
  while (!turns.empty() && !poll.Stopped()) {
    const LatticePoint p = turns.begin()->second;
    turns.erase(turns.begin());
    if (!IsSimple(set.NeighborsOf(p))) continue;
    const NeighborMask neighbors = set.NeighborsOf(p);
    set.Remove(p);
    place.Remove(p);
    ForEachNeighbor(p, neighbors, [&](LatticePoint q) {
      const size_t* n = place.Find(q);
      if (n != nullptr) turns.emplace(*n, q);
    });
  }
}

// From an end along points of two neighbors to the first that has more, which is included.
std::vector<LatticePoint> TwigFrom(const ThinSet& set, LatticePoint end) {
  std::vector<LatticePoint> twig = {end};
  LatticePoint before = end;
  while (set.Degree(twig.back()) <= 2) {
    LatticePoint next = twig.back();
    ForEachNeighbor(twig.back(), set.NeighborsOf(twig.back()), [&](LatticePoint q) {
      if (q != before) next = q;
    });
    if (next == twig.back()) break;  // another end
    before = twig.back();
    twig.push_back(next);
  }
  return twig;
}

// As the slope rule for curves, with the place where the curve leaves the sheet as the junction.
// Returns whether any went.
bool RemoveTwigs(ThinSet& set, double margin, const PointSet& keep) {
  bool any = false;
  for (LatticePoint end : set.Ends()) {
    if (!set.Contains(end) || set.Degree(end) != 1) continue;
    const std::vector<LatticePoint> twig = TwigFrom(set, end);
    const LatticePoint foot = twig.back();
    if (set.Degree(foot) <= 2) continue;
    const double limit = set.RadiusOf(foot) + margin;
    const bool spurious = std::ranges::all_of(twig, [&](LatticePoint p) {
      return !keep.contains(p) && kTwigSlope * set.Between(p, foot) + set.RadiusOf(p) < limit;
    });
    if (!spurious) continue;
    for (size_t n = 0; n + 1 < twig.size(); ++n) set.Remove(twig[n]);
    any = true;
  }
  return any;
}

}  // namespace

absl::StatusOr<PrunedSheets> PruneSheets(const ThinCurves& sheets, double margin,
                                         std::span<const LatticePoint> keep,
                                         const exec::Context& context) {
  ThinSet set(sheets, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  const PointSet kept(keep.begin(), keep.end());
  const SheetBurning burning(set, kept, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  RemoveInTurn(set, burning, margin, context);
  PointSet spared = kept;
  set.ForEachPoint([&](LatticePoint p) {
    if (set.BirthOf(p) > 0) spared.insert(p);
  });
  do {
    RemoveSimplePoints(set, spared);
  } while (RemoveTwigs(set, margin, kept));
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  PrunedSheets pruned{set.ToVolume(sheets.thin), {}};
  pruned.radii = set.RadiiOf(pruned.thin);
  return pruned;
}

}  // namespace bccskel
