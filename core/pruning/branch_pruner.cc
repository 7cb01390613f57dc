#include "core/pruning/branch_pruner.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/exec/stop_poll.h"
#include "core/pruning/persistence.h"
#include "core/pruning/simple_points.h"

namespace bccskel {
namespace {

constexpr uint64_t kStepsOfABranch = 128;  // in a StopPoll: for the work of judging it

}  // namespace

void BranchPruner::Run(const OnRemoved& on_removed, TurnedTips* turned) {
  JudgeAll();
  while (!turns_.empty() && !context_.ShouldStop()) {
    const auto [worth, end] = turns_.top();
    turns_.pop();
    if (!IsEnd(end)) continue;
    const FreeBranch branch = BranchFrom(set_, end);
    const std::optional<double> now = WorthIfSpurious(branch);
    if (!now.has_value()) continue;
    if (*now != worth) {
      turns_.emplace(*now, end);
      continue;
    }
    const FreeBranch going = LessOfTwins(branch, worth);
    if (turned != nullptr) NoteTurned(going, *turned);
    const RemovedBranch removed = RemoveBranch(set_, going, keep_);
    for (LatticePoint p : removed.points) on_removed(p, worth);
    JudgeAround(removed.around);
  }
}

FreeBranch BranchPruner::LessOfTwins(const FreeBranch& branch, double worth) const {
  const bool goes_anyway = worth == -std::numeric_limits<double>::infinity();
  if (rule_ != PruningRule::kSignificance || goes_anyway) return branch;
  const std::optional<FreeBranch> twin = TwinOf(branch);
  if (!twin.has_value()) return branch;
  const double without = LimbWithout(branch, twin->points[0]);
  return LimbWithout(*twin, branch.points[0]) > without ? *twin : branch;
}

std::optional<FreeBranch> BranchPruner::TwinOf(const FreeBranch& branch) const {
  const std::vector<LatticePoint> cluster = ClusterOf(set_, *branch.junction);
  if (cluster.size() >= kMostClusterPoints) return std::nullopt;
  const std::set<LatticePoint> sources(cluster.begin(), cluster.end());
  std::set<LatticePoint> ends;
  for (LatticePoint p : cluster) FindEndsBeyond(p, sources, ends);
  ends.erase(branch.points[0]);
  if (ends.size() != 1) return std::nullopt;
  FreeBranch twin = BranchFrom(set_, *ends.begin());
  if (!MayGo(twin) || WorthOf(twin) >= kDefaultSignificance) return std::nullopt;
  return twin;
}

double BranchPruner::LimbWithout(const FreeBranch& going, LatticePoint end) const {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  ThinSet rest = ThinSet::Over(set_);
  RemoveBranch(rest, going, keep_);
  if (!rest.Contains(end) || !rest.IsEnd(end)) return kNone;
  const FreeBranch limb = BranchFrom(rest, end);
  return limb.junction.has_value() ? significance_.Of(rest, limb) : kNone;
}

void BranchPruner::NoteTurned(const FreeBranch& branch, TurnedTips& turned) const {
  const std::vector<LatticePoint> cluster = ClusterOf(set_, *branch.junction);
  if (cluster.size() >= kMostClusterPoints) return;
  turned.Note(set_, branch, cluster, [&](const FreeBranch& other) { return WorthOf(other); });
}

void BranchPruner::JudgeAll() {
  StopPoll poll(context_);
  std::vector<FreeBranch> branches;
  for (LatticePoint end : set_.Ends()) {
    if (poll.Stopped(kStepsOfABranch)) return;
    FreeBranch branch = BranchFrom(set_, end);
    if (MayGo(branch)) branches.push_back(std::move(branch));
  }
  if (rule_ == PruningRule::kSignificance) {
    const std::vector<double> worths = significance_.OfAll(set_, branches, context_);
    for (size_t n = 0; n < branches.size(); ++n) {
      if (worths[n] < threshold_) turns_.emplace(worths[n], branches[n].points[0]);
    }
    return;
  }
  for (const FreeBranch& branch : branches) {
    if (poll.Stopped(kStepsOfABranch)) return;
    Judge(branch);
  }
}

void BranchPruner::Judge(const FreeBranch& branch) {
  const std::optional<double> worth = WorthIfSpurious(branch);
  if (worth.has_value()) turns_.emplace(*worth, branch.points[0]);
}

bool BranchPruner::MayGo(const FreeBranch& branch) const {
  return branch.junction.has_value() &&
         std::ranges::none_of(branch.points, [&](LatticePoint p) { return keep_.contains(p); });
}

std::optional<double> BranchPruner::WorthIfSpurious(const FreeBranch& branch) const {
  if (!MayGo(branch)) return std::nullopt;
  const double worth = WorthOf(branch);
  return worth < threshold_ ? std::optional(worth) : std::nullopt;
}

double BranchPruner::WorthOf(const FreeBranch& branch) const {
  switch (rule_) {
    case PruningRule::kLength:
      return LengthOfBranch(branch);
    case PruningRule::kRelativeLength:
      return LengthOfBranch(branch) / BallAt(*branch.junction);
    case PruningRule::kPersistence:
      return PersistenceOf(set_, branch);
    default:
      return significance_.Of(set_, branch);
  }
}

// The largest radius in the cluster.
double BranchPruner::BallAt(LatticePoint junction) const {
  float ball = 0;
  for (LatticePoint p : ClusterOf(set_, junction)) ball = std::max(ball, set_.RadiusOf(p));
  return ball;
}

double BranchPruner::LengthOfBranch(const FreeBranch& branch) const {
  double length = set_.Between(branch.points.back(), *branch.junction);
  for (size_t n = 1; n < branch.points.size(); ++n) {
    length += set_.Between(branch.points[n - 1], branch.points[n]);
  }
  return length;
}

// Judges the branches with a free end that start near these places again, each once although it is
// found from several points of its junction.
void BranchPruner::JudgeAround(const std::set<LatticePoint>& places) {
  std::set<LatticePoint> sources, ends;
  for (LatticePoint p : places) {
    if (!set_.Contains(p)) continue;
    sources.insert(p);
    if (!set_.Branches(p)) continue;
    for (LatticePoint q : ClusterOf(set_, p)) sources.insert(q);
  }
  for (LatticePoint p : sources) FindEndsBeyond(p, sources, ends);
  for (LatticePoint end : ends) Judge(BranchFrom(set_, end));
}

// Stops at other sources, which find the rest, so that long branches are followed once.
void BranchPruner::FindEndsBeyond(LatticePoint p, const std::set<LatticePoint>& sources,
                                  std::set<LatticePoint>& ends) const {
  if (set_.IsEnd(p)) ends.insert(p);
  ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint q) {
    if (sources.contains(q)) return;
    LatticePoint previous = p;
    NeighborMask mask = set_.NeighborsOf(q);
    while (IsCurvePoint(mask) && q != p) {
      const LatticePoint next = NextPoint(q, mask, previous);
      previous = q;
      q = next;
      mask = set_.NeighborsOf(q);
    }
    if (IsEndPoint(mask)) ends.insert(q);
  });
}

PruningLevels PruningLevelsOf(ThinSet set, Significance& significance, PruningRule rule,
                              const PointSet& keep, const exec::Context& context) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  PruningLevels levels;
  StopPoll poll(context);
  set.ForEachPoint([&](LatticePoint p) {
    if (!poll.Stopped() && !set.Branches(p)) levels.Set(p, kNever);
  });
  double level = 0;
  const auto record = [&](LatticePoint p, double worth) {
    level = std::max(level, worth);
    if (double* found = levels.Find(p); found != nullptr) *found = level;
  };
  BranchPruner(set, significance, rule, kNever, keep, context).Run(record);
  return levels;
}

}  // namespace bccskel
