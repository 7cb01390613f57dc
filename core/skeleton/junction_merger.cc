#include "core/skeleton/junction_merger.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/distance/places.h"
#include "core/exec/stop_poll.h"
#include "core/skeleton/joined_paths.h"

namespace bccskel {
namespace {

// More junctions in one ball are no place where limbs meet but a sponge: noise that bored tunnels.
// Joined, each of their edges would have to run on to the middle of the body.
constexpr size_t kMostJoined = 16;
// Of the radius: so near to each other, junctions are one for limbs of any width.
constexpr double kOneBall = 0.5;
// In lattice units, added to the reach: by so much sampling moves the junctions of thin tubes,
// whose radius is a few units.
constexpr double kSampling = 1;
// Where limbs cross, the junctions of both sides lie this many reaches apart at most, and each limb
// is straight from a radius outside of them over so many radii and lattice units.
constexpr double kCrossingReach = 3;
constexpr double kStraightRadii = 2;
constexpr double kStraightUnits = 4;
constexpr double kStraightCosine = 0.94;
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

struct OpenEdge {
  uint32_t source;
  uint32_t target;
  Path points;
  double level;
};

// Part of a limb, away from where limbs cross.
struct Ray {
  Coordinates from, to;
};

Coordinates Between(const Coordinates& a, const Coordinates& b) { return Minus(b, a); }

// Whether the way from one point to another follows `along`, of any length.
bool Follows(const Coordinates& way, const Coordinates& along) {
  return Dot(way, along) >= kStraightCosine * std::sqrt(Dot(way, way) * Dot(along, along));
}

// Whether two rays in opposite directions lie in one line.
bool IsLine(const Ray& a, const Ray& b) {
  const Coordinates across = Between(a.from, b.from), out = Between(b.from, b.to);
  const Coordinates in = Between(a.to, a.from);
  return Follows(in, across) && Follows(across, out) && Follows(in, out);
}

class Merger {
 public:
  Merger(double reach, SkeletonGraph& graph, StopPoll& poll)
      : reach_(reach),
        graph_(graph),
        poll_(poll),
        scale_(AxisScaleOf(graph.placement)),
        node_of_(graph.nodes.size(), kNone),
        ways_(graph.nodes.size()),
        first_edge_(graph.nodes.size() + 2),
        edges_at_(2 * graph.edges.size()),
        dissolved_(graph.edges.size()) {
    for (const SkeletonEdge& edge : graph.edges) {
      ++first_edge_[edge.source + 2];
      ++first_edge_[edge.target + 2];
    }
    std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
    for (uint32_t e = 0; e < graph.edges.size(); ++e) {
      edges_at_[first_edge_[graph.edges[e].source + 1]++] = e;
      edges_at_[first_edge_[graph.edges[e].target + 1]++] = e;
    }
  }

  // Returns whether any were joined.
  bool Join() {
    std::vector<uint32_t> deepest_first(graph_.nodes.size());
    std::iota(deepest_first.begin(), deepest_first.end(), 0u);
    std::ranges::stable_sort(deepest_first, std::ranges::greater(),
                             [&](uint32_t n) { return graph_.nodes[n].at.radius; });
    bool any = false;
    for (uint32_t n : deepest_first) {
      if (poll_.Stopped()) return false;
      if (node_of_[n] != kNone || !IsJunction(n)) continue;
      any = TakeIn(n) || any;
    }
    return any;
  }

  void Rebuild();

 private:
  // The way from the middle of the node, the edge, and the junctions it leads from and to.
  using Step = std::tuple<double, uint32_t, uint32_t, uint32_t>;
  using Steps = std::priority_queue<Step, std::vector<Step>, std::greater<>>;

  Coordinates PlaceAt(const SkeletonPoint& p) const { return PlaceOf(p.point, scale_); }
  bool IsJunction(uint32_t n) const { return graph_.nodes[n].kind == NodeKind::kJunction; }

  // Those that begin and end at node n, both ends of a loop.
  std::span<const uint32_t> EdgesAt(uint32_t n) const {
    return std::span(edges_at_).subspan(first_edge_[n], first_edge_[n + 1] - first_edge_[n]);
  }

  // The nearest along the paths first, so that ways inside the node are short.
  bool TakeIn(uint32_t center) {
    std::vector<uint32_t> reached, inside;
    Steps steps;
    const auto take = [&](uint32_t n, double way) {
      node_of_[n] = center;
      reached.push_back(n);
      AddStepsFrom(n, way, center, steps);
    };
    ways_[center] = {graph_.nodes[center].at};
    take(center, 0);
    while (!steps.empty() && reached.size() <= kMostJoined + 1) {
      const auto [way, e, from, to] = steps.top();
      steps.pop();
      if (node_of_[to] != kNone) continue;
      dissolved_[e] = 1;
      inside.push_back(e);
      const Path path = PathOf(graph_.edges[e]);
      ways_[to] = Joined(ways_[from], graph_.edges[e].source == from ? path : Reversed(path));
      take(to, way);
    }
    if (reached.size() > kMostJoined + 1) LetGo(reached, inside);
    if (reached.size() == 1 && CrossAt(center)) return true;
    return node_of_[center] == center && reached.size() > 1;
  }

  // Where two straight limbs cross at a small angle, two junctions share an edge. Its middle
  // becomes one node. Returns whether there is such an edge at the junction.
  bool CrossAt(uint32_t center) {
    for (uint32_t e : EdgesAt(center)) {
      const SkeletonEdge& edge = graph_.edges[e];
      const uint32_t to = edge.source == center ? edge.target : edge.source;
      if (node_of_[to] != kNone || !IsJunction(to) || !IsCrossing(e, center, to)) continue;
      Path path = PathOf(edge);
      if (edge.source != center) path = Reversed(path);
      const auto middle = path.begin() + static_cast<std::ptrdiff_t>(path.size() / 2);
      ways_[to] = {middle, path.end()};
      ways_[center] = Reversed({path.begin(), middle + 1});
      graph_.nodes[center].at = *middle;
      node_of_[to] = center;
      dissolved_[e] = 1;
      return true;
    }
    return false;
  }

  bool IsCrossing(uint32_t e, uint32_t center, uint32_t to) const {
    if (EdgesAt(center).size() != 3 || EdgesAt(to).size() != 3) return false;
    const double radius = graph_.nodes[center].at.radius;
    const double length = LengthOf(graph_.edges[e]);
    if (length > kCrossingReach * reach_ * radius + kSampling) return false;
    const auto points = graph_.PointsOf(graph_.edges[e]);
    const Coordinates middle = PlaceAt(points[points.size() / 2]);
    const auto rays = [&](uint32_t n) {
      std::vector<Ray> found;
      for (uint32_t limb : EdgesAt(n)) {
        if (limb != e) AddRay(limb, n, middle, length / 2 + radius, radius, found);
      }
      return found;
    };
    const std::vector<Ray> here = rays(center), there = rays(to);
    if (here.size() != 2 || there.size() != 2) return false;
    return (IsLine(here[0], there[0]) && IsLine(here[1], there[1])) ||
           (IsLine(here[0], there[1]) && IsLine(here[1], there[0]));
  }

  // None of a limb that is too short for one.
  void AddRay(uint32_t limb, uint32_t n, const Coordinates& middle, double start, double radius,
              std::vector<Ray>& rays) const {
    const double end = start + kStraightRadii * radius + kStraightUnits;
    Path path = PathOf(graph_.edges[limb]);
    if (graph_.edges[limb].source != n) path = Reversed(path);
    const auto beyond = [&](double least) {
      return std::ranges::find_if(path, [&](const SkeletonPoint& p) {
        const Coordinates way = Between(middle, PlaceAt(p));
        return Dot(way, way) >= least * least;
      });
    };
    const auto from = beyond(start), to = beyond(end);
    if (to != path.end()) rays.push_back({PlaceAt(*from), PlaceAt(*to)});
  }

  // To the junctions that the node at `center` may take in next, each with the way there.
  void AddStepsFrom(uint32_t from, double way, uint32_t center, Steps& steps) const {
    for (uint32_t e : EdgesAt(from)) {
      const SkeletonEdge& edge = graph_.edges[e];
      const uint32_t to = edge.source == from ? edge.target : edge.source;
      if (node_of_[to] != kNone || !IsJunction(to) || !IsWithin(e, to, center)) continue;
      steps.emplace(way + LengthOf(edge), e, from, to);
    }
  }

  double LengthOf(const SkeletonEdge& edge) const {
    const auto points = graph_.PointsOf(edge);
    double length = 0;
    for (size_t n = 1; n < points.size(); ++n) {
      length += bccskel::LengthOf(Between(PlaceAt(points[n - 1]), PlaceAt(points[n])));
    }
    return length;
  }

  void LetGo(const std::vector<uint32_t>& junctions, const std::vector<uint32_t>& edges) {
    for (uint32_t n : junctions) {
      node_of_[n] = kNone;
      ways_[n].clear();
    }
    for (uint32_t e : edges) dissolved_[e] = 0;
  }

  // Whether the edge to `to` runs inside the node at `center`: within reach of its ball and of the
  // limbs that leave it at `to`, give or take what sampling moves. Thin limbs that leave a thick
  // body side by side are no one node.
  bool IsWithin(uint32_t e, uint32_t to, uint32_t center) const {
    const SkeletonPoint& at = graph_.nodes[center].at;
    const double ball = reach_ * at.radius + kSampling;
    double radius = ball;
    for (uint32_t other : EdgesAt(to)) {
      if (other == e || IsNear(other, at, ball)) continue;
      radius = std::min(radius, reach_ * MedianRadius(other) + kSampling);
    }
    return IsNear(e, at, std::max(radius, kOneBall * at.radius));
  }

  bool IsNear(uint32_t e, const SkeletonPoint& at, double radius) const {
    return std::ranges::all_of(graph_.PointsOf(graph_.edges[e]), [&](const SkeletonPoint& p) {
      const Coordinates way = Between(PlaceAt(at), PlaceAt(p));
      return Dot(way, way) <= radius * radius;
    });
  }

  double MedianRadius(uint32_t e) const {
    std::vector<float> radii;
    for (const SkeletonPoint& p : graph_.PointsOf(graph_.edges[e])) radii.push_back(p.radius);
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::ranges::nth_element(radii, middle);
    return *middle;
  }

  Path PathOf(const SkeletonEdge& edge) const {
    const auto points = graph_.PointsOf(edge);
    return {points.begin(), points.end()};
  }

  // `changed` receives the points of edges that are dissolved or joined with others.
  std::vector<OpenEdge> RemainingEdges(Path& changed) const;
  std::vector<uint32_t> KeepNodes();
  void SetEdges(std::vector<OpenEdge> edges);
  void AddLostPoints(Path changed);

  const double reach_;
  SkeletonGraph& graph_;
  StopPoll& poll_;
  const AxisScale scale_;
  std::vector<uint32_t> node_of_;     // by junction, the one that it is part of
  std::vector<Path> ways_;            // by junction, from the one that it is part of to it
  std::vector<uint64_t> first_edge_;  // by node, in edges_at_; and the end
  std::vector<uint32_t> edges_at_;    // of all nodes, by node
  std::vector<uint8_t> dissolved_;    // by edge
};

std::vector<OpenEdge> Merger::RemainingEdges(Path& changed) const {
  std::vector<OpenEdge> edges;
  for (uint32_t e = 0; e < graph_.edges.size() && !poll_.Stopped(); ++e) {
    const SkeletonEdge& edge = graph_.edges[e];
    if (dissolved_[e] != 0 || node_of_[edge.source] != kNone || node_of_[edge.target] != kNone) {
      std::ranges::copy(graph_.PointsOf(edge), std::back_inserter(changed));
    }
    if (dissolved_[e] != 0) continue;
    OpenEdge open{edge.source, edge.target, PathOf(edge), edge.pruning_level};
    if (node_of_[edge.source] != kNone) {
      open.source = node_of_[edge.source];
      open.points = Joined(ways_[edge.source], open.points);
    }
    if (node_of_[edge.target] != kNone) {
      open.target = node_of_[edge.target];
      open.points = Reversed(Joined(ways_[edge.target], Reversed(open.points)));
    }
    edges.push_back(std::move(open));
  }
  return edges;
}

// In canonical order; returns where the nodes that stay are now, by node.
std::vector<uint32_t> Merger::KeepNodes() {
  std::vector<uint32_t> order, place(graph_.nodes.size());
  for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
    if (node_of_[n] == kNone || node_of_[n] == n) order.push_back(n);
  }
  std::ranges::sort(order, {}, [&](uint32_t n) { return graph_.nodes[n].at.point; });
  std::vector<SkeletonNode> kept;
  for (uint32_t n : order) {
    place[n] = static_cast<uint32_t>(kept.size());
    kept.push_back(graph_.nodes[n]);
  }
  graph_.nodes = std::move(kept);
  return place;
}

// In canonical order.
void Merger::SetEdges(std::vector<OpenEdge> edges) {
  for (OpenEdge& edge : edges) {
    if (poll_.Stopped(edge.points.size())) return;
    Path back = Reversed(edge.points);
    if (std::tie(edge.target, edge.source, back) <
        std::tie(edge.source, edge.target, edge.points)) {
      std::swap(edge.source, edge.target);
      edge.points = std::move(back);
    }
  }
  std::ranges::sort(edges, {}, [](const OpenEdge& edge) {
    return std::tie(edge.source, edge.target, edge.points);
  });
  graph_.edges.clear();
  graph_.points.clear();
  for (const OpenEdge& edge : edges) {
    if (poll_.Stopped(edge.points.size())) return;
    graph_.edges.push_back(
        {edge.source, edge.target, graph_.points.size(), edge.points.size(), edge.level});
    graph_.points.insert(graph_.points.end(), edge.points.begin(), edge.points.end());
  }
}

// Cutting paths short may leave points beside them, which are thick spots now.
void Merger::AddLostPoints(Path changed) {
  std::ranges::sort(changed);
  std::vector<char> stays(changed.size());
  const auto mark = [&](const SkeletonPoint& p) {
    const auto [first, last] = std::equal_range(changed.begin(), changed.end(), p);
    for (auto at = first; at != last; ++at) stays[static_cast<size_t>(at - changed.begin())] = 1;
  };
  for (const SkeletonPoint& p : graph_.points) {
    if (poll_.Stopped()) return;
    mark(p);
  }
  for (const SkeletonNode& node : graph_.nodes) mark(node.at);
  Path lost;
  for (size_t n = 0; n < changed.size(); ++n) {
    if (stays[n] == 0) lost.push_back(changed[n]);
  }
  if (lost.empty()) return;
  graph_.sheets.insert(graph_.sheets.end(), lost.begin(), lost.end());
  std::ranges::sort(graph_.sheets);
  graph_.sheets.erase(std::unique(graph_.sheets.begin(), graph_.sheets.end()), graph_.sheets.end());
}

void Merger::Rebuild() {
  Path changed;
  std::vector<OpenEdge> edges = RemainingEdges(changed);
  if (poll_.StoppedNow()) return;
  const std::vector<uint32_t> place = KeepNodes();
  for (OpenEdge& edge : edges) {
    edge.source = place[edge.source];
    edge.target = place[edge.target];
  }
  SetEdges(std::move(edges));
  AddLostPoints(std::move(changed));
}

}  // namespace

absl::Status CheckJunctionReach(double reach) {
  if (reach >= 0 && reach <= kMaxJunctionReach) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "reach of junctions %g: must be 0 (no junctions are merged) to %g radii of the junction's "
      "ball",
      reach, kMaxJunctionReach));
}

absl::Status MergeJunctions(double reach, const exec::Context& context, SkeletonGraph& graph) {
  if (reach == 0) return absl::OkStatus();
  StopPoll poll(context);
  Merger merger(reach, graph, poll);
  if (merger.Join()) merger.Rebuild();
  return context.StopStatus();
}

}  // namespace bccskel
