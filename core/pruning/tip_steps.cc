#include "core/pruning/tip_steps.h"

#include <algorithm>
#include <functional>

namespace bccskel {
namespace {

constexpr size_t kHeadingPoints = 10;     // the heading is the direction of the last ten points
constexpr double kLeastTurnCosine = 0.4;  // between the heading and a step
constexpr double kCosineWeight = 0.5;     // weight of that cosine against the rise of the depth

}  // namespace

// Finding depths is slow, so the most promising steps come first and rule out most others.
std::optional<LatticePoint> TipSteps::Next(std::span<const LatticePoint> path,
                                           LatticePoint anchor) {
  const double depth = depth_.At(path.back());
  const Step* best = nullptr;
  double best_score = 0;
  Find(path, anchor, depth);
  for (const Step& step : steps_) {
    if (best != nullptr && step.score_most < best_score) break;
    const double score = (depth_.At(step.to) - depth) / step.length + step.straightness;
    const bool is_better =
        best == nullptr || score > best_score || (score == best_score && step.rank < best->rank);
    if (!is_better) continue;
    best = &step;
    best_score = score;
  }
  return best == nullptr ? std::nullopt : std::optional(best->to);
}

void TipSteps::Find(std::span<const LatticePoint> path, LatticePoint anchor, double depth) {
  const LatticePoint tip = path.back();
  const LatticePoint from =
      path.size() > kHeadingPoints ? path[path.size() - 1 - kHeadingPoints] : anchor;
  steps_.clear();
  for (size_t rank = 0; rank < kDirections14.size(); ++rank) {
    const LatticePoint to = tip + kDirections14[rank];
    const double cosine = Cosine(from, tip, to);
    if (cosine < kLeastTurnCosine || !IsFreeWay(tip, to, anchor)) continue;
    const double length = set_.Between(tip, to), straightness = kCosineWeight * cosine;
    const double score_most = (depth_.AtMost(to) - depth) / length + straightness;
    steps_.push_back({to, rank, length, straightness, score_most});
  }
  std::ranges::sort(steps_, std::ranges::greater(), &Step::score_most);
}

bool TipSteps::IsFreeWay(LatticePoint tip, LatticePoint next, LatticePoint anchor) {
  if (!bricks_.Contains(next) || set_.Contains(next)) return false;
  if (set_.Between(next, anchor) <= set_.Between(tip, anchor)) return false;
  return IsEndPoint(set_.NeighborsAround(next));
}

// Between the ways a -> b and b -> c, by the law of cosines.
double TipSteps::Cosine(LatticePoint a, LatticePoint b, LatticePoint c) const {
  const double ab = set_.Between(a, b), bc = set_.Between(b, c), ac = set_.Between(a, c);
  return (ac * ac - ab * ab - bc * bc) / (2 * ab * bc);
}

}  // namespace bccskel
