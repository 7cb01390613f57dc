#include "client/view/result_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::pair<std::string_view, NodeKind>, 5> kKinds = {{
    {"end", NodeKind::kEnd},
    {"junction", NodeKind::kJunction},
    {"loop", NodeKind::kLoop},
    {"isolated", NodeKind::kIsolated},
    {"closed_surface", NodeKind::kClosedSurface},
}};
constexpr std::array<std::pair<std::string_view, PreparingStepKind>, 5> kSteps = {{
    {"denoise", PreparingStepKind::kDenoise},
    {"fill-cavities", PreparingStepKind::kFillCavities},
    {"fill-tunnels", PreparingStepKind::kFillTunnels},
    {"drop-small-components", PreparingStepKind::kDropSmallComponents},
    {"keep-largest-component", PreparingStepKind::kKeepLargestComponent},
}};

absl::Status NoResult(const char* place, const char* expected) {
  return absl::InvalidArgumentError(
      absl::StrCat("no JSON result of bccskel: ", place, " is not ", expected));
}

template <typename Names>
auto FindName(const Names& names, std::string_view name) {
  const auto at = std::ranges::find(names, name, [](const auto& entry) { return entry.first; });
  using Value = decltype(names[0].second);
  return at == names.end() ? std::nullopt : std::optional<std::decay_t<Value>>(at->second);
}

// A whole number of a member; 0 where there is none.
template <typename Integer>
absl::Status ReadCount(const Json& from, const char* name, Integer& to) {
  const auto member = from.find(name);
  if (member == from.end()) return absl::OkStatus();
  const bool fits =
      member->is_number_integer() && *member >= 0 && *member <= std::numeric_limits<Integer>::max();
  if (!fits) return NoResult(name, "a count");
  to = member->get<Integer>();
  return absl::OkStatus();
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

absl::Status ReadBirths(const Json& from, std::span<SkeletonPoint> points) {
  const auto births = from.find("births");
  if (births == from.end()) return absl::OkStatus();
  if (!births->is_array() || births->size() != points.size()) {
    return NoResult("births", "one for each point");
  }
  for (size_t n = 0; n < points.size(); ++n) {
    const Json one = {{"birth", (*births)[n]}};
    BCCSKEL_RETURN_IF_ERROR(ReadCount(one, "birth", points[n].birth));
  }
  return absl::OkStatus();
}

absl::Status ReadShifts(const Json& from, std::span<SkeletonPoint> points) {
  const auto shifts = from.find("shifts");
  if (shifts == from.end()) return absl::OkStatus();
  constexpr const char* kWhat = "three whole numbers for each point";
  if (!shifts->is_array() || shifts->size() != points.size()) return NoResult("shifts", kWhat);
  for (size_t n = 0; n < points.size(); ++n) {
    const Json& shift = (*shifts)[n];
    if (!shift.is_array() || shift.size() != 3) return NoResult("shifts", kWhat);
    for (size_t axis = 0; axis < 3; ++axis) {
      const bool fits =
          shift[axis].is_number_integer() && shift[axis] >= INT16_MIN && shift[axis] <= INT16_MAX;
      if (!fits) return NoResult("shifts", kWhat);
      points[n].shift[axis] = shift[axis].get<int16_t>();
    }
  }
  return absl::OkStatus();
}

class GraphReader {
 public:
  GraphReader(const ResultDocument& document, const Json& json)
      : document_(document), json_(json), lattice_(*document.placement) {}

  absl::StatusOr<SkeletonGraph> Run() && {
    graph_.placement = *document_.placement;
    for (size_t n = 0; n < document_.nodes.size(); ++n) BCCSKEL_RETURN_IF_ERROR(AddNode(n));
    for (size_t n = 0; n < document_.edges.size(); ++n) BCCSKEL_RETURN_IF_ERROR(AddEdge(n));
    BCCSKEL_RETURN_IF_ERROR(
        AddPoints(document_.sheets.points, document_.sheets.radii, graph_.sheets));
    if (json_.contains("sheets")) {
      BCCSKEL_RETURN_IF_ERROR(ReadBirths(json_["sheets"], graph_.sheets));
    }
    return std::move(graph_);
  }

 private:
  absl::Status AddNode(size_t n) {
    const ResultDocument::Node& from = document_.nodes[n];
    SkeletonNode& node = graph_.nodes.emplace_back();
    const auto kind = FindName(kKinds, from.kind);
    if (!kind.has_value()) return NoResult("kind", "a kind of node");
    node.kind = *kind;
    BCCSKEL_ASSIGN_OR_RETURN(node.at, lattice_.PointAt(from.position, from.radius));
    const Json& json = json_["nodes"][n];
    BCCSKEL_RETURN_IF_ERROR(ReadCount(json, "birth", node.at.birth));
    BCCSKEL_RETURN_IF_ERROR(ReadCount(json, "loops", node.loops));
    return ReadCount(json, "cavities", node.cavities);
  }

  absl::Status AddEdge(size_t n) {
    const ResultDocument::Edge& from = document_.edges[n];
    SkeletonEdge edge = {.source = static_cast<uint32_t>(from.source),
                         .target = static_cast<uint32_t>(from.target),
                         .first_point = graph_.points.size(),
                         .point_count = from.points.size()};
    BCCSKEL_RETURN_IF_ERROR(AddPoints(from.points, from.radii, graph_.points));
    const std::span points = std::span(graph_.points).subspan(edge.first_point);
    const Json& json = json_["edges"][n];
    BCCSKEL_RETURN_IF_ERROR(ReadBirths(json, points));
    BCCSKEL_RETURN_IF_ERROR(ReadShifts(json, points));
    if (const auto level = json.find("pruning_level"); level != json.end()) {
      if (!level->is_number()) return NoResult("pruning_level", "a number");
      edge.pruning_level = level->get<double>();
    }
    graph_.edges.push_back(edge);
    return absl::OkStatus();
  }

  absl::Status AddPoints(const std::vector<WorldPoint>& at, const std::vector<double>& radii,
                         std::vector<SkeletonPoint>& to) const {
    for (size_t n = 0; n < at.size(); ++n) {
      BCCSKEL_ASSIGN_OR_RETURN(to.emplace_back(), lattice_.PointAt(at[n], radii[n]));
    }
    return absl::OkStatus();
  }

  const ResultDocument& document_;
  const Json& json_;
  const Lattice lattice_;
  SkeletonGraph graph_;
};

absl::Status ReadPreparing(const Json& json, std::vector<PreparingStep>& steps) {
  const auto list = json.find("preparing");
  if (list == json.end()) return absl::OkStatus();
  for (const Json& from : *list) {
    const Json name = from.is_object() ? from.value("step", Json()) : Json();
    const auto kind = name.is_string() ? FindName(kSteps, name.get<std::string>()) : std::nullopt;
    if (!kind.has_value()) return NoResult("preparing", "a list of steps");
    PreparingStep& step = steps.emplace_back();
    step.kind = *kind;
    BCCSKEL_RETURN_IF_ERROR(ReadCount(from, "count", step.count));
    BCCSKEL_RETURN_IF_ERROR(ReadCount(from, "points_added", step.points_added));
    BCCSKEL_RETURN_IF_ERROR(ReadCount(from, "points_removed", step.points_removed));
  }
  return absl::OkStatus();
}

absl::Status ReadRoot(const Json& json, ResultGraph& result) {
  const auto order = json.find("order");
  if (order == json.end()) return absl::OkStatus();
  const Json roots = order->is_object() ? order->value("roots", Json()) : Json();
  if (!roots.is_array()) return NoResult("roots", "a list of nodes");
  RootChoice choice = {.rule = RootChoice::Rule::kNodes};
  for (const Json& root : roots) {
    const Json one = {{"roots", root}};
    BCCSKEL_RETURN_IF_ERROR(ReadCount(one, "roots", choice.nodes.emplace_back()));
  }
  if (!CheckRootChoice(choice, result.graph).ok()) return NoResult("roots", "a list of nodes");
  result.root = std::move(choice);
  return absl::OkStatus();
}

std::string TextOf(const Json& json, const char* name) {
  const auto member = json.find(name);
  if (member == json.end()) return "unknown";
  return member->is_string() ? member->get<std::string>() : member->dump();
}

}  // namespace

absl::StatusOr<ResultGraph> ResultGraphOf(const ResultDocument& document) {
  if (!document.placement.has_value()) return NoResult("placement", "there");
  const Json& json = *document.json;
  ResultGraph result;
  BCCSKEL_ASSIGN_OR_RETURN(result.graph, GraphReader(document, json).Run());
  result.method = TextOf(json, "method");
  result.algorithm_version = TextOf(json, "algorithm_version");
  result.world = TextOf(json, "world");
  result.unit = TextOf(json, "unit");
  result.options = document.options;
  BCCSKEL_RETURN_IF_ERROR(ReadPreparing(json, result.preparing));
  BCCSKEL_RETURN_IF_ERROR(ReadRoot(json, result));
  result.certificate = document.certificate;
  result.object_points = document.object_points;
  return result;
}

absl::StatusOr<ResultGraph> ReadResultGraph(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(const ResultDocument document, ReadResultDocument(path));
  absl::StatusOr<ResultGraph> result = ResultGraphOf(document);
  if (result.ok()) return result;
  return absl::Status(result.status().code(), absl::StrCat(path, ": ", result.status().message()));
}

}  // namespace bccskel::view
