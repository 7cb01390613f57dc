#include "core/skeleton/tree_order.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel {
namespace {

double SquaredDistance(const WorldPoint& p, const WorldPoint& q) {
  const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
  return x * x + y * y + z * z;
}

class Ordering {
 public:
  Ordering(const SkeletonGraph& graph, const RootChoice& choice, const std::stop_token& stop)
      : graph_(graph), choice_(choice), stop_(stop), components_(ComponentsOf(graph, stop)) {
    figures_.reserve(graph.edges.size());
    for (const SkeletonEdge& edge : graph.edges) {
      if (stop.stop_requested()) break;
      figures_.push_back(FiguresOf(graph, edge));
    }
    edges_at_.resize(graph.nodes.size());
    for (uint32_t e = 0; e < graph.edges.size(); ++e) {
      edges_at_[graph.edges[e].source].push_back(e);
      edges_at_[graph.edges[e].target].push_back(e);
    }
    order_.rule = choice.rule;
    order_.nodes.resize(graph.nodes.size());
    order_.edges.resize(graph.edges.size());
    parent_edge_.resize(graph.nodes.size(), kNoRow);
    reached_.resize(graph.nodes.size());
    chosen_.resize(graph.nodes.size());
    if (choice.rule != RootChoice::Rule::kNodes) return;
    for (const uint32_t node : choice.nodes) chosen_[node] = 1;
  }

  TreeOrder Run() && {
    if (stop_.stop_requested()) return std::move(order_);
    ChooseRoots();
    for (uint32_t root : order_.roots) GrowFrom(root);
    CountGenerations();
    CountStrahler();
    const auto cut = std::ranges::count_if(order_.edges, &EdgeOrder::ClosesLoop);
    order_.loops_cut = static_cast<uint64_t>(cut);
    return std::move(order_);
  }

 private:
  // The smaller, the better a root; the node itself decides last.
  using Worth = std::tuple<int, double, double, uint32_t>;

  Worth WorthOf(uint32_t node) const {
    const SkeletonNode& at = graph_.nodes[node];
    if (chosen_[node] != 0) return {0, 0, 0, node};
    if (choice_.rule == RootChoice::Rule::kNearestNode) {
      return {1, SquaredDistance(graph_.PositionOf(at.at), choice_.point), 0, node};
    }
    if (choice_.rule == RootChoice::Rule::kDeepestNode) return {1, -at.at.radius, 0, node};
    if (at.kind != NodeKind::kEnd || edges_at_[node].empty()) return {2, 0, -at.at.radius, node};
    return {1, -figures_[edges_at_[node].front()].mean_radius, -at.at.radius, node};
  }

  void ChooseRoots() {
    constexpr Worth kWorst = {3, 0, 0, kNoRow};
    std::vector<Worth> best(components_.figures.size(), kWorst);
    for (uint32_t node = 0; node < graph_.nodes.size(); ++node) {
      Worth& so_far = best[components_.of_node[node]];
      so_far = std::min(so_far, WorthOf(node));
    }
    for (const Worth& worth : best) order_.roots.push_back(std::get<uint32_t>(worth));
  }

  uint32_t OtherEnd(uint32_t edge, uint32_t node) const {
    const SkeletonEdge& e = graph_.edges[edge];
    return e.source == node ? e.target : e.source;
  }

  // Dijkstra's algorithm.
  void GrowFrom(uint32_t root) {
    using Way = std::tuple<double, uint32_t, uint32_t>;  // length, last edge, node
    std::priority_queue<Way, std::vector<Way>, std::greater<>> open;
    open.emplace(0, kNoRow, root);
    while (!open.empty() && !stop_.stop_requested()) {
      const auto [length, edge, node] = open.top();
      open.pop();
      if (reached_[node] != 0) continue;
      reached_[node] = 1;
      Settle(node, edge, length, root);
      for (uint32_t next : edges_at_[node]) {
        const uint32_t beyond = OtherEnd(next, node);
        if (reached_[beyond] == 0) open.emplace(length + figures_[next].length, next, beyond);
      }
    }
  }

  void Settle(uint32_t node, uint32_t edge, double length, uint32_t root) {
    outward_.push_back(node);
    NodeOrder& order = order_.nodes[node];
    order.root = root;
    order.root_distance = length;
    if (edge == kNoRow) return;
    parent_edge_[node] = edge;
    order.parent = OtherEnd(edge, node);
    order_.edges[edge].proximal = order.parent;
  }

  bool LeadsAway(uint32_t edge, uint32_t node) const { return order_.edges[edge].proximal == node; }

  void CountGenerations() {
    for (uint32_t node : outward_) {
      const auto away = [&](uint32_t edge) { return LeadsAway(edge, node); };
      const bool forks = std::ranges::count_if(edges_at_[node], away) > 1;
      const uint32_t parent = parent_edge_[node];
      const uint32_t next =
          parent == kNoRow ? 0 : order_.edges[parent].generation + (forks ? 1 : 0);
      for (uint32_t edge : edges_at_[node]) {
        if (away(edge)) order_.edges[edge].generation = next;
      }
    }
  }

  // From the leaves to the roots.
  void CountStrahler() {
    for (auto node = outward_.rbegin(); node != outward_.rend(); ++node) {
      if (parent_edge_[*node] == kNoRow) continue;
      uint32_t highest = 0, times = 0;
      for (uint32_t edge : edges_at_[*node]) {
        if (!LeadsAway(edge, *node)) continue;
        const uint32_t strahler = order_.edges[edge].strahler;
        times = strahler > highest ? 1 : times + (strahler == highest ? 1 : 0);
        highest = std::max(highest, strahler);
      }
      order_.edges[parent_edge_[*node]].strahler = highest == 0 ? 1 : highest + (times > 1 ? 1 : 0);
    }
  }

  const SkeletonGraph& graph_;
  const RootChoice& choice_;
  const std::stop_token& stop_;
  const GraphComponents components_;
  std::vector<EdgeFigures> figures_;
  std::vector<std::vector<uint32_t>> edges_at_;  // by node; an edge to itself twice
  std::vector<uint32_t> parent_edge_;            // by node
  std::vector<uint8_t> reached_;                 // by node
  std::vector<uint8_t> chosen_;                  // by node
  std::vector<uint32_t> outward_;                // nodes, each after its parent
  TreeOrder order_;
};

}  // namespace

absl::Status CheckRootChoice(const RootChoice& choice, const SkeletonGraph& graph) {
  for (const uint32_t node : choice.nodes) {
    if (node < graph.nodes.size()) continue;
    return absl::InvalidArgumentError(absl::StrCat("root node ", node, ": the skeleton has ",
                                                   graph.nodes.size(), " nodes, counted from 0"));
  }
  return absl::OkStatus();
}

std::string RootWarning(const RootChoice& choice, const SkeletonGraph& graph) {
  if (choice.rule != RootChoice::Rule::kNearestNode || graph.nodes.empty()) return "";
  const auto distance = [&](const SkeletonPoint& p) {
    return std::sqrt(SquaredDistance(graph.PositionOf(p), choice.point));
  };
  const auto reaches = [&](const SkeletonPoint& p) { return distance(p) <= 2 * graph.RadiusOf(p); };
  if (std::ranges::any_of(graph.nodes, reaches, &SkeletonNode::at)) return "";
  if (std::ranges::any_of(graph.points, reaches)) return "";
  const auto nearest = std::ranges::min_element(
      graph.nodes, {}, [&](const SkeletonNode& n) { return distance(n.at); });
  return absl::StrCat("the root is far from the skeleton, ", distance(nearest->at),
                      " from the nearest node, ", nearest - graph.nodes.begin(),
                      "; its coordinates are those of the world, as results state them");
}

uint32_t TreeOrder::MostGenerations() const {
  uint32_t most = 0;
  for (const EdgeOrder& edge : edges) most = std::max(most, edge.generation);
  return most;
}

uint32_t TreeOrder::HighestStrahler() const {
  uint32_t highest = 0;
  for (const EdgeOrder& edge : edges) highest = std::max(highest, edge.strahler);
  return highest;
}

TreeOrder OrderTrees(const SkeletonGraph& graph, const RootChoice& choice,
                     const std::stop_token& stop) {
  return Ordering(graph, choice, stop).Run();
}

}  // namespace bccskel
