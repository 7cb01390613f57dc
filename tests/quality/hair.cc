#include "tests/quality/hair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <unordered_map>

#include "core/skeleton/skeleton_figures.h"
#include "tests/quality/measure.h"

namespace bccskel::quality {
namespace {

constexpr double kInside = 0.9;  // of a ball
constexpr double kWay = 2;       // radii

// A point of an edge, in world units.
struct Bead {
  size_t edge = 0;
  Vector place;
  double radius = 0;
  double from_source = 0;  // along the edge
  double to_target = 0;
  double share = 0;  // of the edge's length that is the bead's
  bool redundant = false;
};

double LengthBetween(const Bead& a, const Bead& b) { return Length(a.place - b.place); }

std::vector<Bead> BeadsOf(const SkeletonGraph& graph, size_t edge) {
  const std::span<const SkeletonPoint> points = graph.PointsOf(graph.edges[edge]);
  const std::vector<WorldPoint> curve = SmoothCurve(graph, graph.edges[edge]);
  std::vector<Bead> beads;
  double way = 0;
  for (size_t n = 0; n < points.size(); ++n) {
    Bead bead = {.edge = edge, .place = {curve[n][0], curve[n][1], curve[n][2]}};
    bead.radius = graph.RadiusOf(points[n]);
    if (n > 0) {
      const double step = LengthBetween(beads.back(), bead);
      beads.back().share += step / 2;
      bead.share = step / 2;
      way += step;
    }
    bead.from_source = way;
    beads.push_back(bead);
  }
  for (Bead& bead : beads) bead.to_target = way - bead.from_source;
  return beads;
}

// Cutting ends never takes these, however often.
std::vector<bool> EdgesThatStay(const SkeletonGraph& graph) {
  std::vector<int> degrees(graph.nodes.size());
  for (const SkeletonEdge& edge : graph.edges) {
    ++degrees[edge.source];
    ++degrees[edge.target];
  }
  std::vector<bool> stays(graph.edges.size(), true);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t n = 0; n < graph.edges.size(); ++n) {
      const SkeletonEdge& edge = graph.edges[n];
      if (!stays[n] || (degrees[edge.source] > 1 && degrees[edge.target] > 1)) continue;
      stays[n] = false;
      changed = true;
      --degrees[edge.source];
      --degrees[edge.target];
    }
  }
  return stays;
}

// Beads by place, in cubes.
class BeadGrid {
 public:
  BeadGrid(std::vector<Bead>& beads, double cube) : beads_(beads), cube_(cube) {
    for (size_t n = 0; n < beads.size(); ++n) cubes_[KeyOf(beads[n].place)].push_back(n);
  }

  template <typename Visit>
  void ForEachWithin(Vector place, double reach, Visit visit) {
    const Vector by = {reach, reach, reach};
    const std::array<int, 3> low = KeyOf(place - by), high = KeyOf(place + by);
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          const auto cube = cubes_.find({x, y, z});
          if (cube == cubes_.end()) continue;
          for (const size_t n : cube->second) {
            if (Length(beads_[n].place - place) < reach) visit(beads_[n]);
          }
        }
      }
    }
  }

 private:
  std::array<int, 3> KeyOf(Vector p) const {
    const auto at = [&](double v) { return static_cast<int>(std::floor(v / cube_)); };
    return {at(p.x), at(p.y), at(p.z)};
  }

  std::vector<Bead>& beads_;
  const double cube_;
  std::map<std::array<int, 3>, std::vector<size_t>> cubes_;
};

// Ways along the graph between nodes that are near.
class GraphWays {
 public:
  GraphWays(const SkeletonGraph& graph, const std::vector<double>& lengths)
      : at_(graph.nodes.size()) {
    for (size_t n = 0; n < graph.edges.size(); ++n) {
      const SkeletonEdge& edge = graph.edges[n];
      at_[edge.source].push_back({edge.target, lengths[n]});
      at_[edge.target].push_back({edge.source, lengths[n]});
    }
  }

  using Ways = std::unordered_map<uint32_t, double>;
  Ways From(uint32_t node, double reach) const {
    using Step = std::pair<double, uint32_t>;
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    Ways ways;
    front.push({0, node});
    while (!front.empty()) {
      const auto [way, place] = front.top();
      front.pop();
      if (!ways.emplace(place, way).second) continue;
      for (const auto& [next, length] : at_[place]) {
        if (way + length <= reach) front.push({way + length, next});
      }
    }
    return ways;
  }

 private:
  std::vector<std::vector<std::pair<uint32_t, double>>> at_;
};

double WayTo(const GraphWays::Ways& ways, uint32_t node) {
  const auto found = ways.find(node);
  return found == ways.end() ? std::numeric_limits<double>::infinity() : found->second;
}

// From where the branch leaves the ball of its junction to its end, against its radius there.
bool IsTwig(const SkeletonGraph& graph, const std::vector<Bead>& beads, const SkeletonEdge& edge) {
  const bool from_source = graph.nodes[edge.source].kind == NodeKind::kJunction;
  const SkeletonNode& junction = graph.nodes[from_source ? edge.source : edge.target];
  const SkeletonNode& end = graph.nodes[from_source ? edge.target : edge.source];
  if (junction.kind != NodeKind::kJunction || end.kind != NodeKind::kEnd) return false;
  const WorldPoint at = graph.PositionOf(junction.at);
  const double ball = graph.RadiusOf(junction.at);
  for (size_t n = 0; n < beads.size(); ++n) {
    const Bead& bead = beads[from_source ? n : beads.size() - 1 - n];
    if (Length(bead.place - Vector{at[0], at[1], at[2]}) < ball) continue;
    return (from_source ? bead.to_target : bead.from_source) < bead.radius;
  }
  return true;  // it never does
}

void MarkRedundant(const SkeletonGraph& graph, const std::vector<std::vector<Bead>>& by_edge,
                   std::vector<Bead>& candidates) {
  std::vector<double> lengths;
  double largest = 1e-9;
  for (const std::vector<Bead>& beads : by_edge) {
    lengths.push_back(beads.empty() ? 0 : beads.back().from_source);
    for (const Bead& bead : beads) largest = std::max(largest, bead.radius);
  }
  BeadGrid grid(candidates, largest / 4);
  const GraphWays ways(graph, lengths);
  for (size_t n = 0; n < by_edge.size(); ++n) {
    double reach = 0;
    for (const Bead& bead : by_edge[n]) reach = std::max(reach, kWay * bead.radius);
    const GraphWays::Ways from_source = ways.From(graph.edges[n].source, reach);
    const GraphWays::Ways from_target = ways.From(graph.edges[n].target, reach);
    for (const Bead& ball : by_edge[n]) {
      const auto way_to = [&](uint32_t node) {
        return std::min(ball.from_source + WayTo(from_source, node),
                        ball.to_target + WayTo(from_target, node));
      };
      grid.ForEachWithin(ball.place, kInside * ball.radius, [&](Bead& bead) {
        if (bead.edge == n || bead.redundant) return;
        const SkeletonEdge& edge = graph.edges[bead.edge];
        const double way =
            std::min(way_to(edge.source) + bead.from_source, way_to(edge.target) + bead.to_target);
        bead.redundant = way > kWay * ball.radius;
      });
    }
  }
}

}  // namespace

Hair HairOf(const SkeletonGraph& graph) {
  const std::vector<bool> stays = EdgesThatStay(graph);
  std::vector<std::vector<Bead>> by_edge;
  std::vector<Bead> candidates;
  Hair hair;
  double length = 0, redundant = 0;
  for (size_t n = 0; n < graph.edges.size(); ++n) {
    by_edge.push_back(BeadsOf(graph, n));
    const std::vector<Bead>& beads = by_edge.back();
    if (!beads.empty()) length += beads.back().from_source;
    if (!stays[n]) candidates.insert(candidates.end(), beads.begin(), beads.end());
    hair.twigs += IsTwig(graph, beads, graph.edges[n]) ? 1 : 0;
  }
  MarkRedundant(graph, by_edge, candidates);
  for (const Bead& bead : candidates) redundant += bead.redundant ? bead.share : 0;
  if (length > 0) hair.redundant_length = redundant / length;
  return hair;
}

namespace {

// A world point in voxels.
class VoxelFrame {
 public:
  explicit VoxelFrame(const Placement& placement) : placement_(placement) {}

  Vector At(const WorldPoint& p) const {
    std::array<double, 3> voxel = {};
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t row = 0; row < 3; ++row) {
        voxel[axis] += placement_.direction[3 * row + axis] * (p[row] - placement_.origin[row]);
      }
      voxel[axis] /= placement_.spacing[axis];
    }
    return {voxel[0], voxel[1], voxel[2]};
  }
  // The edge of a cube as large as a voxel.
  double Edge() const {
    return std::cbrt(placement_.spacing[0] * placement_.spacing[1] * placement_.spacing[2]);
  }
  double InVoxels(double length, size_t axis) const { return length / placement_.spacing[axis]; }

 private:
  const Placement& placement_;
};

void TakeBall(VoxelMask& mask, const VoxelFrame& frame, const WorldPoint& at, double radius) {
  const Vector middle = frame.At(at);
  const double rx = frame.InVoxels(radius, 0), ry = frame.InVoxels(radius, 1),
               rz = frame.InVoxels(radius, 2);
  const auto first = [](double low) { return static_cast<int32_t>(std::ceil(std::max(low, 0.0))); };
  for (int32_t z = first(middle.z - rz); z <= middle.z + rz && z < mask.grid().nz; ++z) {
    for (int32_t y = first(middle.y - ry); y <= middle.y + ry && y < mask.grid().ny; ++y) {
      const double dy = (y - middle.y) / ry, dz = (z - middle.z) / rz;
      const double half = rx * std::sqrt(std::max(1 - dy * dy - dz * dz, 0.0));
      for (int32_t x = first(middle.x - half); x <= middle.x + half && x < mask.grid().nx; ++x) {
        if (mask.Holds({x, y, z})) mask.Flip({x, y, z});
      }
    }
  }
}

// Takes a connected group away and returns its size.
int TakeGroup(VoxelMask& mask, Voxel start) {
  int size = 0;
  std::vector<Voxel> front = {start};
  mask.Flip(start);
  while (!front.empty()) {
    const Voxel v = front.back();
    front.pop_back();
    ++size;
    for (int place = 0; place < 27; ++place) {
      const Voxel w = {v[0] + place % 3 - 1, v[1] + place / 3 % 3 - 1, v[2] + place / 9 - 1};
      if (!mask.Holds(w)) continue;
      mask.Flip(w);
      front.push_back(w);
    }
  }
  return size;
}

}  // namespace

int CountMissedParts(const SkeletonGraph& graph, const VoxelMask& mask) {
  constexpr double kOutside = 4;
  constexpr int kSmall = 20;
  const VoxelFrame frame(mask.grid().placement);
  VoxelMask left = mask;
  const auto take = [&](const SkeletonPoint& p) {
    TakeBall(left, frame, graph.PositionOf(p), graph.RadiusOf(p) + kOutside * frame.Edge());
  };
  for (const SkeletonPoint& p : graph.points) take(p);
  for (const SkeletonPoint& p : graph.sheets) take(p);
  for (const SkeletonNode& node : graph.nodes) take(node.at);
  std::vector<Voxel> voxels;
  left.ForEachVoxel([&](Voxel v) { voxels.push_back(v); });
  int parts = 0;
  for (const Voxel& v : voxels) {
    if (left.Holds(v) && TakeGroup(left, v) > kSmall) ++parts;
  }
  return parts;
}

}  // namespace bccskel::quality
