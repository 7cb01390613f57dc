#include "core/skeleton/cluster_tree.h"

#include <algorithm>
#include <tuple>

namespace bccskel {

ClusterTree::ClusterTree(PointIndex root, const std::function<PointIndex(PointIndex)>& parent,
                         std::span<const PointIndex> terminals, bool stays)
    : root_(root) {
  spots_[root].parent = root;
  for (PointIndex p : terminals) {
    auto [spot, is_new] = spots_.try_emplace(p);
    ++spot->second.fan;
    while (is_new) {
      const PointIndex above = parent(p);
      spot->second.parent = above;
      std::tie(spot, is_new) = spots_.try_emplace(above);
      ++spot->second.fan;
      p = above;
    }
  }
  while (!stays && spots_[root_].fan < 3) MoveRoot(terminals);
}

// To the first fork below. The way there has none, so it turns around, or goes if nothing else
// starts at the old root; then the fork may have two ways only, and the next move turns.
void ClusterTree::MoveRoot(std::span<const PointIndex> terminals) {
  PointPath way;
  for (PointIndex p : terminals) {
    for (way = {root_}; p != root_; p = spots_[p].parent) {
      if (spots_[p].fan > 1) way = {p};
      if (way.front() != root_ && way.back() != p) way.push_back(p);
    }
    if (way.front() != root_) break;
  }
  way.push_back(root_);
  const bool turns = --spots_[root_].fan > 0;
  root_ = way.front();
  for (size_t n = 1; n < way.size(); ++n) {
    if (turns) {
      spots_[way[n]].parent = way[n - 1];
    } else {
      spots_.erase(way[n]);
    }
  }
  spots_[root_].parent = root_;
  if (turns) ++spots_[root_].fan;
}

std::vector<PointIndex> ClusterTree::Nodes() const {
  std::vector<PointIndex> nodes;
  for (const auto& [p, spot] : spots_) {
    if (IsNode(p, spot)) nodes.push_back(p);
  }
  std::ranges::sort(nodes);
  return nodes;
}

PointPath ClusterTree::UpToNode(PointPath path) const {
  for (auto spot = spots_.find(path.back()); !IsNode(spot->first, spot->second);
       spot = spots_.find(path.back())) {
    path.push_back(spot->second.parent);
  }
  std::ranges::reverse(path);
  return path;
}

PointPath ClusterTree::StemOf(PointIndex terminal) const { return UpToNode({terminal}); }

PointPath ClusterTree::LimbOf(PointIndex node) const {
  return UpToNode({node, spots_.at(node).parent});
}

}  // namespace bccskel
