// Does: points -> clusters -> branches -> graph, then brings the graph into its canonical order;
//       what is on no path of it are sheets.
// Why it is right: see clusters.h for the topology; a cluster's own loops become edges from
//       its node to itself, or numbers of the node where a cavity leaves a closed surface. A large
//       cluster becomes a tree of nodes, which its loops close: as many loops.
// Cost: sorting the points and 14 walks over them; the rest follows clusters and branches.
#include "core/skeleton/trace_skeleton.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/skeleton/branches.h"
#include "core/skeleton/cluster_loops.h"
#include "core/skeleton/cluster_tree.h"
#include "core/skeleton/clusters.h"
#include "core/skeleton/spanning_trees.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {
namespace {

NodeKind KindOf(const Cluster& cluster) {
  if (cluster.cavities > 0) return NodeKind::kClosedSurface;
  if (cluster.loops == 1 && cluster.branches == 0) return NodeKind::kLoop;
  if (cluster.loops > 0 || cluster.branches > 1) return NodeKind::kJunction;
  return cluster.branches == 1 ? NodeKind::kEnd : NodeKind::kIsolated;
}

// Position of a node in the order in which it was found.
using NodeIndex = uint32_t;

struct TracedEdge {
  NodeIndex source;
  NodeIndex target;
  PointPath points;
};

// Of a cluster whose edges have more points than both inside it, paths share theirs.
constexpr size_t kPathPointsPerPoint = 4;
constexpr size_t kFewPathPoints = 4096;

class GraphBuilder {
 public:
  GraphBuilder(const ThinPoints& points, const Clusters& clusters, exec::MemoryBudget& memory,
               StopPoll& poll)
      : points_(points),
        clusters_(clusters),
        memory_(memory),
        poll_(poll),
        room_(kEdgePointsPerPoint * points.size() + kEdgePointsAtOnce),
        node_of_(clusters.size()),
        on_graph_(points.size()),
        loops_(points, clusters, poll),
        paths_(points, clusters.inner_masks()) {}

  void AddClusters(const Branches& branches) {
    FindStarts(branches);
    for (ClusterIndex c = 0; c < clusters_.size() && !Stopped(); ++c) {
      if (!clusters_[c].IsBend()) AddCluster(c);
    }
  }

  void AddBranches(const Branches& branches) {
    for (const Branch& branch : branches.between) {
      if (Stopped()) return;
      AddBranch(branch);
    }
    for (const PointPath& curve : branches.closed) {
      if (Stopped()) return;
      AddClosedCurve(curve);
    }
  }

  // Not OK where the memory for more points on edges was refused; then the graph is incomplete.
  const absl::Status& refused() const { return refused_; }

  // Incomplete where the poll says to stop, as all before.
  SkeletonGraph Finish(const Placement& placement) &&;

 private:
  static constexpr size_t kEdgePointsAtOnce = size_t{1} << 16;

  bool Stopped() { return poll_.Stopped() || !refused_.ok(); }

  // Asks for more where `points` more points on edges do not fit into what was taken.
  bool HasRoomFor(size_t points) {
    if (points > room_) {
      const size_t more = points - room_ + kEdgePointsAtOnce;
      refused_ = memory_.TakeFor(more, kTraceBytesPerEdgePoint, "more points on edges");
      if (!refused_.ok()) return false;
      room_ += more;
    }
    room_ -= points;
    return true;
  }

  // Where branches start in clusters that may be large.
  void FindStarts(const Branches& branches) {
    const auto add = [&](ClusterIndex c, PointIndex p) {
      const Cluster& cluster = clusters_[c];
      const size_t paths = cluster.branches + 2 * size_t{cluster.loops};
      if (paths * cluster.points.size() > kFewPathPoints) starts_[c].push_back(p);
    };
    for (const Branch& branch : branches.between) {
      add(branch.source, branch.points.front());
      add(branch.target, branch.points.back());
    }
  }

  void AddCluster(ClusterIndex c) {
    const Cluster& cluster = clusters_[c];
    const NodeKind kind = KindOf(cluster);
    PointIndex at = points_.DeepestOf(cluster.points);
    SkeletonNode node{kind, {}, 0, 0};
    ClusterLoops loops;
    if (kind == NodeKind::kClosedSurface) {
      node.loops = cluster.loops;
      node.cavities = cluster.cavities;
    } else if (cluster.loops > 0) {
      loops = loops_.Find(cluster);
      at = loops.at;
    }
    if (cluster.branches > 0) paths_.GrowFrom(at, poll_);
    if (Stopped()) return;
    if (IsLarge(c, loops.chords)) {
      AddTree(c, at, node, loops.chords);
      return;
    }
    node_of_[c] = AddNode(at, node);
    for (const Chord& chord : loops.chords) {
      AddEdge(node_of_[c], node_of_[c], loops_.CloseLoop(chord));
    }
  }

  bool IsLarge(ClusterIndex c, std::span<const Chord> chords) const {
    size_t steps = 0;
    for (const Chord& chord : chords) steps += chord.steps + 1;
    if (const auto starts = starts_.find(c); starts != starts_.end()) {
      for (PointIndex p : starts->second) steps += paths_.Depth(p);
    }
    return steps > std::max(kPathPointsPerPoint * clusters_[c].points.size(), kFewPathPoints);
  }

  void AddTree(ClusterIndex c, PointIndex at, const SkeletonNode& node,
               std::span<const Chord> chords) {
    PointPath terminals = starts_[c];
    for (const Chord& chord : chords) terminals.insert(terminals.end(), {chord.a, chord.b});
    const auto parent = [&](PointIndex p) {
      return !chords.empty() && loops_.IsInTree(p) ? loops_.Parent(p) : paths_.Parent(p);
    };
    const bool stays = node.kind == NodeKind::kClosedSurface;
    const ClusterTree& tree = trees_.try_emplace(c, at, parent, terminals, stays).first->second;
    const SkeletonNode junction{NodeKind::kJunction, {}, 0, 0};
    const PointPath nodes = tree.Nodes();
    if (poll_.StoppedNow()) return;
    for (PointIndex p : nodes) node_at_[p] = AddNode(p, p == tree.root() ? node : junction);
    for (PointIndex p : nodes) {
      if (p == tree.root()) continue;
      if (Stopped()) return;
      PointPath limb = tree.LimbOf(p);
      const NodeIndex from = node_at_.at(limb.front());
      AddEdge(from, node_at_.at(p), std::move(limb));
    }
    for (const Chord& chord : chords) AddPath(StemOf(c, chord.a), {}, StemOf(c, chord.b));
  }

  NodeIndex AddNode(PointIndex at, SkeletonNode node) {
    node.at = points_[at];
    on_graph_[at] = 1;
    nodes_.push_back(node);
    return static_cast<NodeIndex>(nodes_.size() - 1);
  }

  // The path inside a cluster to a point of it, and the node where it starts.
  struct Stem {
    NodeIndex node;
    PointPath path;
  };
  Stem StemOf(ClusterIndex c, PointIndex p) const {
    const auto tree = trees_.find(c);
    if (tree == trees_.end()) return {node_of_[c], paths_.PathTo(p)};
    PointPath path = tree->second.StemOf(p);
    return {node_at_.at(path.front()), std::move(path)};
  }

  void AddPath(Stem source, std::span<const PointIndex> between, const Stem& target) {
    PointPath path = std::move(source.path);
    path.insert(path.end(), between.begin(), between.end());
    path.insert(path.end(), target.path.rbegin(), target.path.rend());
    AddEdge(source.node, target.node, std::move(path));
  }

  void AddBranch(const Branch& branch) {
    AddPath(StemOf(branch.source, branch.points.front()),
            std::span(branch.points).subspan(1, branch.points.size() - 2),
            StemOf(branch.target, branch.points.back()));
  }

  void AddClosedCurve(const PointPath& curve) {
    PointPath turned(curve.begin(), curve.end() - 1);
    std::rotate(turned.begin(), std::ranges::find(turned, points_.DeepestOf(turned)), turned.end());
    turned.push_back(turned.front());
    const auto node = static_cast<NodeIndex>(nodes_.size());
    nodes_.push_back({NodeKind::kLoop, points_[turned.front()], 0, 0});
    AddEdge(node, node, std::move(turned));
  }

  void AddEdge(NodeIndex source, NodeIndex target, PointPath path) {
    if (!HasRoomFor(path.size())) return;
    for (PointIndex p : path) on_graph_[p] = 1;
    edges_.push_back({source, target, std::move(path)});
  }

  void SortNodes();
  void TurnEdges();

  const ThinPoints& points_;
  const Clusters& clusters_;
  exec::MemoryBudget& memory_;
  StopPoll& poll_;
  size_t room_;  // points on edges for which there is memory
  absl::Status refused_;
  std::vector<NodeIndex> node_of_;  // by cluster, for those that have one node
  std::map<ClusterIndex, PointPath> starts_;
  std::map<ClusterIndex, ClusterTree> trees_;  // of large clusters
  std::map<PointIndex, NodeIndex> node_at_;    // in them
  std::vector<uint8_t> on_graph_;              // by point, whether it is a node's or on an edge
  ClusterLoopFinder loops_;
  SpanningTrees paths_;
  std::vector<SkeletonNode> nodes_;
  std::vector<TracedEdge> edges_;
};

void GraphBuilder::SortNodes() {
  std::vector<NodeIndex> order(nodes_.size());
  std::iota(order.begin(), order.end(), NodeIndex{0});
  std::ranges::sort(order, {}, [&](NodeIndex n) { return nodes_[n].at.point; });
  std::vector<SkeletonNode> sorted;
  std::vector<NodeIndex> place(nodes_.size());
  for (NodeIndex n : order) {
    place[n] = static_cast<NodeIndex>(sorted.size());
    sorted.push_back(nodes_[n]);
  }
  nodes_ = std::move(sorted);
  for (TracedEdge& edge : edges_) {
    edge.source = place[edge.source];
    edge.target = place[edge.target];
  }
}

// The list of points is in lattice order, so positions in it compare like the points.
void GraphBuilder::TurnEdges() {
  for (TracedEdge& edge : edges_) {
    if (poll_.Stopped()) return;
    PointPath back(edge.points.rbegin(), edge.points.rend());
    if (std::tie(edge.target, edge.source, back) <
        std::tie(edge.source, edge.target, edge.points)) {
      std::swap(edge.source, edge.target);
      edge.points = std::move(back);
    }
  }
  std::ranges::sort(edges_, {}, [](const TracedEdge& edge) {
    return std::tie(edge.source, edge.target, edge.points);
  });
}

SkeletonGraph GraphBuilder::Finish(const Placement& placement) && {
  SortNodes();
  TurnEdges();
  SkeletonGraph graph;
  graph.placement = placement;
  size_t points = 0;
  for (const TracedEdge& edge : edges_) points += edge.points.size();
  graph.points.reserve(points);
  graph.nodes = std::move(nodes_);
  for (const TracedEdge& edge : edges_) {
    if (poll_.StoppedNow()) break;
    SkeletonEdge& added = graph.edges.emplace_back(
        SkeletonEdge{edge.source, edge.target, graph.points.size(), edge.points.size()});
    double level = kNoLevel;
    for (PointIndex p : edge.points) {
      graph.points.push_back(points_[p]);
      level = std::max(level, points_.level(p));
    }
    if (level != kNoLevel) added.pruning_level = level;
  }
  for (PointIndex p = 0; p < points_.size() && !poll_.Stopped(); ++p) {
    if (on_graph_[p] == 0) graph.sheets.push_back(points_[p]);
  }
  return graph;
}

}  // namespace

absl::StatusOr<SkeletonGraph> TraceSkeleton(const ThinSkeleton& skeleton,
                                            const exec::Context& context) {
  exec::UnlimitedMemory memory;
  return TraceSkeleton(skeleton, memory, context);
}

absl::StatusOr<SkeletonGraph> TraceSkeleton(const ThinSkeleton& skeleton,
                                            exec::MemoryBudget& memory,
                                            const exec::Context& context) {
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  StopPoll poll(context);
  const ThinPoints points(skeleton, poll);
  if (poll.Stopped()) return context.StopStatus();
  const Clusters clusters(points, poll);
  if (poll.Stopped()) return context.StopStatus();
  const Branches branches = FollowBranches(points, clusters, poll);
  GraphBuilder builder(points, clusters, memory, poll);
  builder.AddClusters(branches);
  if (poll.Stopped()) return context.StopStatus();
  builder.AddBranches(branches);
  if (!builder.refused().ok()) return builder.refused();
  SkeletonGraph graph = std::move(builder).Finish(skeleton.points.placement());
  if (poll.Stopped()) return context.StopStatus();
  return graph;
}

}  // namespace bccskel
