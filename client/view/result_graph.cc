#include "client/view/result_graph.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/skeleton/node_kind_name.h"

namespace bccskel::view {
namespace {

constexpr std::array kKinds = {NodeKind::kEnd, NodeKind::kJunction, NodeKind::kLoop,
                               NodeKind::kIsolated, NodeKind::kClosedSurface};

absl::Status NoResult(const char* place, const char* expected) {
  return absl::InvalidArgumentError(
      absl::StrCat("not a JSON result of bccskel: ", place, " is not ", expected));
}

// From world coordinates back to lattice points.
class Lattice {
 public:
  explicit Lattice(const Placement& placement) : placement_(placement) {
    const auto& d = placement.direction;
    const auto minor = [&d](size_t a, size_t b, size_t c, size_t e) {
      return d[a] * d[e] - d[b] * d[c];
    };
    inverse_ = {minor(4, 5, 7, 8), minor(2, 1, 8, 7), minor(1, 2, 4, 5),
                minor(5, 3, 8, 6), minor(0, 2, 6, 8), minor(2, 0, 5, 3),
                minor(3, 4, 6, 7), minor(1, 0, 7, 6), minor(0, 1, 3, 4)};
    determinant_ = d[0] * inverse_[0] + d[1] * inverse_[3] + d[2] * inverse_[6];
  }

  absl::StatusOr<SkeletonPoint> PointAt(const WorldPoint& at, double radius) const {
    std::array<double, 3> lattice;
    for (size_t axis = 0; axis < 3; ++axis) {
      double along = 0;
      for (size_t n = 0; n < 3; ++n) {
        along += inverse_[3 * axis + n] / determinant_ * (at[n] - placement_.origin[n]);
      }
      lattice[axis] = std::nearbyint(2 * along / placement_.spacing[axis]);
    }
    const double smallest = std::ranges::min(placement_.spacing);
    const bool fits = std::ranges::all_of(
        lattice, [](double along) { return std::abs(along) < double{1 << 30}; });
    const WorldPoint back = placement_.ToWorld(lattice[0], lattice[1], lattice[2]);
    for (size_t n = 0; n < 3; ++n) {
      const double most = 1e-3 * smallest + 1e-12 * std::abs(at[n]);
      if (!fits || !(std::abs(back[n] - at[n]) <= most)) {
        return NoResult("a position", "on the lattice of its placement");
      }
    }
    SkeletonPoint point;
    point.point = {static_cast<int32_t>(lattice[0]), static_cast<int32_t>(lattice[1]),
                   static_cast<int32_t>(lattice[2])};
    point.radius = static_cast<float>(2 * radius / smallest);
    return point;
  }

 private:
  Placement placement_;
  std::array<double, 9> inverse_;
  double determinant_;
};

class GraphReader {
 public:
  GraphReader(const ResultDocument& document, const std::stop_token& stop)
      : document_(document), stop_(stop), lattice_(*document.placement) {}

  absl::StatusOr<SkeletonGraph> Run() && {
    graph_.placement = *document_.placement;
    for (const auto& node : document_.nodes) BCCSKEL_RETURN_IF_ERROR(AddNode(node));
    BCCSKEL_RETURN_IF_ERROR(
        AddPoints(document_.points, document_.radii, document_.births, graph_.points));
    for (size_t n = 0; n < document_.shifts.size(); ++n) {
      graph_.points[n].shift = document_.shifts[n];
    }
    for (const auto& edge : document_.edges) {
      graph_.edges.push_back({.source = static_cast<uint32_t>(edge.source),
                              .target = static_cast<uint32_t>(edge.target),
                              .first_point = edge.first_point,
                              .point_count = edge.point_count,
                              .pruning_level = edge.pruning_level});
    }
    const ResultDocument::Sheets& sheets = document_.sheets;
    BCCSKEL_RETURN_IF_ERROR(AddPoints(sheets.points, sheets.radii, sheets.births, graph_.sheets));
    return std::move(graph_);
  }

 private:
  absl::Status AddNode(const ResultDocument::Node& from) {
    SkeletonNode& node = graph_.nodes.emplace_back();
    const auto kind = std::ranges::find(kKinds, from.kind, NodeKindName);
    if (kind == kKinds.end()) return NoResult("kind", "a kind of node");
    node.kind = *kind;
    BCCSKEL_ASSIGN_OR_RETURN(node.at, lattice_.PointAt(from.position, from.radius));
    node.at.birth = from.birth;
    node.loops = from.loops;
    node.cavities = from.cavities;
    return absl::OkStatus();
  }

  absl::Status AddPoints(const std::vector<WorldPoint>& at, const std::vector<double>& radii,
                         const std::vector<int32_t>& births, std::vector<SkeletonPoint>& to) const {
    for (size_t n = 0; n < at.size(); ++n) {
      if (n % 4096 == 0 && stop_.stop_requested()) return absl::CancelledError("interrupted");
      BCCSKEL_ASSIGN_OR_RETURN(to.emplace_back(), lattice_.PointAt(at[n], radii[n]));
      if (!births.empty()) to.back().birth = births[n];
    }
    return absl::OkStatus();
  }

  const ResultDocument& document_;
  const std::stop_token& stop_;
  const Lattice lattice_;
  SkeletonGraph graph_;
};

absl::Status ReadRoots(const ResultDocument& document, ResultGraph& result) {
  if (!document.roots.has_value()) return absl::OkStatus();
  RootChoice choice = {.rule = RootChoice::Rule::kNodes, .nodes = *document.roots};
  if (document.root_rule == "thickest-node") choice = {.rule = RootChoice::Rule::kDeepestNode};
  if (!CheckRootChoice(choice, result.graph).ok()) return NoResult("roots", "a list of nodes");
  result.root = std::move(choice);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ResultGraph> ResultGraphOf(const ResultDocument& document,
                                          const std::stop_token& stop) {
  if (!document.placement.has_value()) return NoResult("placement", "there");
  ResultGraph result;
  static_cast<ResultFacts&>(result) = document;
  BCCSKEL_ASSIGN_OR_RETURN(result.graph, GraphReader(document, stop).Run());
  BCCSKEL_RETURN_IF_ERROR(ReadRoots(document, result));
  return result;
}

}  // namespace bccskel::view
