#include "tests/quality/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/lattice/directions.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::quality {

using shapes::RoundCone;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Foot {
  Vector at;
  double radius = 0;
};

// The nearest place of the center line, by brute force over its pieces.
class CenterLine {
 public:
  explicit CenterLine(const PlacedFigure& placed) {
    for (const RoundCone& piece : placed.figure.line) {
      line_.push_back({placed.ToLattice(piece.from), placed.ToLattice(piece.to),
                       placed.scale * piece.from_radius, placed.scale * piece.to_radius});
    }
  }

  Foot FootOf(Vector p) const {
    Foot best;
    double nearest = kFar;
    for (const RoundCone& piece : line_) {
      const Vector axis = piece.to - piece.from;
      const double t = std::clamp(Dot(p - piece.from, axis) / Dot(axis, axis), 0.0, 1.0);
      const Vector at = piece.from + t * axis;
      const double square = Dot(p - at, p - at);
      if (square >= nearest) continue;
      nearest = square;
      best = {at, piece.from_radius + t * (piece.to_radius - piece.from_radius)};
    }
    return best;
  }

  double Length() const {
    double length = 0;
    for (const RoundCone& piece : line_) length += shapes::Length(piece.to - piece.from);
    return length;
  }

 private:
  std::vector<RoundCone> line_;
};

Offsets OffsetsOf(std::span<const Vector> places, const CenterLine& line) {
  Offsets offsets;
  Vector sum;
  for (const Vector& p : places) {
    const Vector way = p - line.FootOf(p).at;
    const double length = Length(way);
    offsets.mean += length;
    offsets.largest = std::max(offsets.largest, length);
    sum = sum + way;
  }
  if (places.empty()) return offsets;
  offsets.mean /= static_cast<double>(places.size());
  offsets.bias = Length(sum) / static_cast<double>(places.size());
  return offsets;
}

Vector ToVector(LatticePoint p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}
Vector ToVector(const WorldPoint& p, const Placement& placement) {
  // Objects of this study lie on the axes of the world.
  return {2 * (p[0] - placement.origin[0]) / placement.spacing[0],
          2 * (p[1] - placement.origin[1]) / placement.spacing[1],
          2 * (p[2] - placement.origin[2]) / placement.spacing[2]};
}

std::vector<Vector> EndsOf(const SkeletonGraph& graph) {
  std::vector<Vector> ends;
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind == NodeKind::kEnd) ends.push_back(ToVector(node.at.point));
  }
  return ends;
}

// An end farther than two radii and eight units from a tip is not its.
TipMatch MatchTips(const PlacedFigure& placed, std::span<const Vector> ends) {
  const std::vector<RoundCone>& tips = placed.figure.tips;
  std::vector<TipPair> pairs;
  for (size_t t = 0; t < tips.size(); ++t) {
    for (size_t e = 0; e < ends.size(); ++e) {
      const double gap = Length(ends[e] - placed.ToLattice(tips[t].to));
      if (gap <= 2 * placed.scale * tips[t].to_radius + 8) pairs.push_back({gap, t, e});
    }
  }
  return MatchNearest(std::move(pairs), tips.size(), ends.size());
}

void JudgeRadii(const SkeletonGraph& graph, const CenterLine& line, Judgment& judgment) {
  for (const SkeletonPoint& p : graph.points) {
    const double error = p.radius - line.FootOf(ToVector(p.point)).radius;
    judgment.radius_bias += error;
    judgment.radius_error += std::abs(error);
  }
  const auto count = static_cast<double>(std::max<size_t>(graph.points.size(), 1));
  judgment.radius_bias /= count;
  judgment.radius_error /= count;
}

// Points with three and more neighbors, or with two that are neighbors of each other.
double ClusteredShare(const Volume& thin) {
  uint64_t clustered = 0, all = 0;
  thin.ForEachPoint([&](LatticePoint p) {
    std::vector<LatticePoint> around;
    for (const LatticePoint offset : kDirections14) {
      if (thin.Contains(p + offset)) around.push_back(offset);
    }
    const bool bend = around.size() == 2 && FindDirection(around[1] - around[0]).has_value();
    clustered += around.size() > 2 || bend ? 1 : 0;
    ++all;
  });
  return all == 0 ? 0 : static_cast<double>(clustered) / static_cast<double>(all);
}

double SumOfNearest(std::span<const Vector> from, std::span<const Vector> to, double& largest) {
  double sum = 0;
  for (const Vector& p : from) {
    double nearest = kFar;
    for (const Vector& q : to) nearest = std::min(nearest, Dot(p - q, p - q));
    sum += std::sqrt(nearest);
    largest = std::max(largest, std::sqrt(nearest));
  }
  return sum;
}

}  // namespace

TipMatch MatchNearest(std::vector<TipPair> pairs, size_t tips, size_t ends) {
  std::ranges::sort(pairs, {}, &TipPair::gap);
  std::vector<bool> tip_taken(tips), end_taken(ends);
  TipMatch match;
  for (const TipPair& pair : pairs) {
    if (tip_taken[pair.tip] || end_taken[pair.end]) continue;
    tip_taken[pair.tip] = end_taken[pair.end] = true;
    ++match.found;
    match.mean_gap += pair.gap;
    match.largest_gap = std::max(match.largest_gap, pair.gap);
  }
  if (match.found > 0) match.mean_gap /= match.found;
  match.lost = static_cast<int>(tips) - match.found;
  match.spurious = static_cast<int>(ends) - match.found;
  return match;
}

std::vector<Vector> RawPoints(const SkeletonGraph& graph) {
  std::vector<Vector> points;
  for (const SkeletonPoint& p : graph.points) points.push_back(ToVector(p.point));
  return points;
}

std::vector<Vector> SmoothPoints(const SkeletonGraph& graph) {
  std::vector<Vector> points;
  for (const SkeletonEdge& edge : graph.edges) {
    for (const WorldPoint& p : SmoothCurve(graph, edge)) {
      points.push_back(ToVector(p, graph.placement));
    }
  }
  return points;
}

int CountNodes(const SkeletonGraph& graph, NodeKind kind) {
  return static_cast<int>(std::ranges::count(graph.nodes, kind, &SkeletonNode::kind));
}

Judgment Judge(const PlacedFigure& placed, const SkeletonizeResult& result) {
  Judgment judgment;
  judgment.ends = CountNodes(result.graph, NodeKind::kEnd);
  judgment.junctions = CountNodes(result.graph, NodeKind::kJunction);
  judgment.tips = MatchTips(placed, EndsOf(result.graph));
  judgment.clustered = ClusteredShare(result.thin);
  judgment.simple_left = result.certificate.simple_points_left;
  if (placed.figure.line.empty()) return judgment;
  const CenterLine line(placed);
  judgment.raw = OffsetsOf(RawPoints(result.graph), line);
  judgment.smooth = OffsetsOf(SmoothPoints(result.graph), line);
  JudgeRadii(result.graph, line, judgment);
  const double length = TotalOf(ComponentsOf(result.graph)).length * 2;  // a cell has two units
  judgment.length_error = length / line.Length() - 1;
  return judgment;
}

SetDistance DistanceBetween(std::span<const Vector> a, std::span<const Vector> b) {
  SetDistance distance;
  if (a.empty() || b.empty()) return distance;
  const double sum = SumOfNearest(a, b, distance.largest) + SumOfNearest(b, a, distance.largest);
  distance.mean = sum / static_cast<double>(a.size() + b.size());
  return distance;
}

}  // namespace bccskel::quality
