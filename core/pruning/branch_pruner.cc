#include "core/pruning/branch_pruner.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/topology/neighborhood.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

// A cavity leaves a whole surface as one cluster; what lies this far from the branch says nothing
// about it.
constexpr size_t kMostClusterPoints = 64;

}  // namespace

uint64_t BranchPruner::Run(const OnRemoved& on_removed) {
  uint64_t removed = 0;
  for (LatticePoint end : set_.Ends()) Judge(end);
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
    for (LatticePoint p : Remove(branch)) on_removed(p, worth);
    ++removed;
  }
  return removed;
}

void BranchPruner::Judge(LatticePoint end) {
  const std::optional<double> worth = WorthIfSpurious(BranchFrom(set_, end));
  if (worth.has_value()) turns_.emplace(*worth, end);
}

std::optional<double> BranchPruner::WorthIfSpurious(const FreeBranch& branch) const {
  if (!branch.junction.has_value()) return std::nullopt;
  if (std::ranges::any_of(branch.points, [&](LatticePoint p) { return keep_.contains(p); })) {
    return std::nullopt;
  }
  const LatticePoint junction = *branch.junction;
  float ball = 0;
  for (LatticePoint p : ClusterOf(junction)) ball = std::max(ball, set_.RadiusOf(p));
  if (rule_ == PruningRule::kSlope) return WorthBySlope(branch, junction, ball);
  const double unit = rule_ == PruningRule::kLength ? 1.0 : double{ball};
  const double worth = LengthTo(branch, junction) / unit;
  return worth < threshold_ ? std::optional(worth) : std::nullopt;
}

// How far the branch reaches out of the junction's ball, its slope given.
std::optional<double> BranchPruner::WorthBySlope(const FreeBranch& branch, LatticePoint junction,
                                                 float ball) const {
  double worth = -std::numeric_limits<double>::infinity();
  for (LatticePoint p : branch.points) {
    worth = std::max(worth, 0.5 * set_.Between(p, junction) + set_.RadiusOf(p) - ball);
    if (worth >= threshold_) return std::nullopt;
  }
  return worth;
}

double BranchPruner::LengthTo(const FreeBranch& branch, LatticePoint junction) const {
  double length = set_.Between(branch.points.back(), junction);
  for (size_t n = 1; n < branch.points.size(); ++n) {
    length += set_.Between(branch.points[n - 1], branch.points[n]);
  }
  return length;
}

// Points with three and more neighbors around a junction point.
std::vector<LatticePoint> BranchPruner::ClusterOf(LatticePoint junction) const {
  std::vector<LatticePoint> cluster = {junction};
  for (size_t n = 0; n < cluster.size() && cluster.size() < kMostClusterPoints; ++n) {
    ForEachNeighbor(cluster[n], set_.NeighborsOf(cluster[n]), [&](LatticePoint q) {
      if (set_.Degree(q) > 2 && std::ranges::find(cluster, q) == cluster.end()) {
        cluster.push_back(q);
      }
    });
  }
  return cluster;
}

// Returns the points that went: the branch's and some at the junction.
std::vector<LatticePoint> BranchPruner::Remove(const FreeBranch& branch) {
  std::vector<LatticePoint> removed = branch.points;
  for (LatticePoint p : branch.points) set_.Remove(p);
  for (LatticePoint p : CleanUpAround(*branch.junction, removed)) {
    if (set_.Contains(p)) JudgeAround(p);
  }
  return removed;
}

// Removes what is simple now, shallow points first. Returns the places that were looked at.
std::vector<LatticePoint> BranchPruner::CleanUpAround(LatticePoint junction,
                                                      std::vector<LatticePoint>& removed) {
  std::vector<LatticePoint> seen = {junction};
  std::set<std::pair<float, LatticePoint>> turns = {{set_.RadiusOf(junction), junction}};
  const auto add = [&](LatticePoint q) {
    turns.emplace(set_.RadiusOf(q), q);
    if (std::ranges::find(seen, q) == seen.end()) seen.push_back(q);
  };
  ForEachNeighbor(junction, set_.NeighborsOf(junction), add);
  while (!turns.empty()) {
    const LatticePoint p = turns.begin()->second;
    turns.erase(turns.begin());
    const NeighborMask neighbors = set_.NeighborsOf(p);
    if (!IsSimpleNonEnd(neighbors) || keep_.contains(p)) continue;
    set_.Remove(p);
    removed.push_back(p);
    ForEachNeighbor(p, neighbors, add);
  }
  return seen;
}

// Looks again at the branches with a free end that start near p.
void BranchPruner::JudgeAround(LatticePoint p) {
  if (set_.Degree(p) <= 2) {
    JudgeBeyond(p);
    return;
  }
  for (LatticePoint q : ClusterOf(p)) JudgeBeyond(q);
}

void BranchPruner::JudgeBeyond(LatticePoint p) {
  if (set_.Degree(p) == 1) Judge(p);
  ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint q) {
    LatticePoint previous = p;
    while (set_.Degree(q) == 2 && q != p) {
      const LatticePoint next = NextPoint(q, set_.NeighborsOf(q), previous);
      previous = q;
      q = next;
    }
    if (set_.Degree(q) == 1) Judge(q);
  });
}

}  // namespace bccskel
