#include "client/view/page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_replace.h"
#include "client/view/display_curve.h"
#include "client/view/first_view.h"
#include "client/view/packed_numbers.h"
#include "client/view/page_parts.h"
#include "client/view/pruning_steps.h"
#include "client/view/sheet_surface.h"
#include "core/exec/status_macros.h"
#include "core/skeleton/node_kind_name.h"

namespace bccskel::view {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr uint32_t kSteps = 65535;

// Quantizes coordinates to steps of a cube that contains everything.
struct Quantizer {
  WorldPoint low;
  double step;

  uint32_t operator()(double value, size_t axis) const {
    return static_cast<uint32_t>(std::lround((value - low[axis]) / step));
  }
};

// Empty where `low` is not below `high`.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  WorldPoint low = {kInfinity, kInfinity, kInfinity};
  WorldPoint high = {-kInfinity, -kInfinity, -kInfinity};

  void Include(const WorldPoint& p, double around) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis] - around);
      high[axis] = std::max(high[axis], p[axis] + around);
    }
  }
};

Box BoxOf(const PageContent& content) {
  Box box;
  for (const ResultDocument::Node& node : content.result.nodes) {
    box.Include(node.position, node.radius);
  }
  const ResultDocument& result = content.result;
  for (size_t n = 0; n < result.points.size(); ++n) box.Include(result.points[n], result.radii[n]);
  for (const WorldPoint& p : result.curves) box.Include(p, 0);
  const ResultDocument::Sheets& sheets = result.sheets;
  for (size_t n = 0; n < sheets.points.size(); ++n) box.Include(sheets.points[n], sheets.radii[n]);
  if (content.peeling.layers.empty()) return box;
  for (const WorldPoint& v : content.peeling.layers.front().surface.vertices) box.Include(v, 0);
  return box;
}

Quantizer QuantizerFor(Box box) {
  if (!(box.low[0] <= box.high[0])) return {{0, 0, 0}, 1};
  WorldPoint& low = box.low;
  double edge = 0;
  for (size_t axis = 0; axis < 3; ++axis) edge = std::max(edge, box.high[axis] - low[axis]);
  // A margin, because smoothed inner layers of thin objects may protrude from the outermost.
  const double margin = edge / 64;
  for (double& coordinate : low) coordinate -= margin;
  return {low, edge > 0 ? (edge + 2 * margin) / kSteps : 1};
}

absl::StatusOr<OrderedJson> SurfaceJson(const std::vector<WorldPoint>& vertices,
                                        const std::vector<SurfaceTriangle>& triangles,
                                        const Quantizer& quantize) {
  std::vector<uint32_t> coordinates, corners;
  for (size_t axis = 0; axis < 3; ++axis) {  // one axis after the other keeps differences small
    for (const WorldPoint& v : vertices) coordinates.push_back(quantize(v[axis], axis));
  }
  for (const SurfaceTriangle& triangle : triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  BCCSKEL_ASSIGN_OR_RETURN(std::string packed_coordinates, PackNumbers(coordinates));
  BCCSKEL_ASSIGN_OR_RETURN(std::string packed_corners, PackNumbers(corners));
  return OrderedJson{{"vertices", vertices.size()},
                     {"triangles", triangles.size()},
                     {"coordinates", std::move(packed_coordinates)},
                     {"corners", std::move(packed_corners)}};
}

// Radii are in steps of the quantizer, too.
absl::StatusOr<OrderedJson> SheetsJson(const SheetSurface& sheets, const Quantizer& quantize) {
  BCCSKEL_ASSIGN_OR_RETURN(OrderedJson json,
                           SurfaceJson(sheets.vertices, sheets.triangles, quantize));
  std::vector<uint32_t> radii;
  for (const double radius : sheets.radii) radii.push_back(quantize(radius + quantize.low[0], 0));
  BCCSKEL_ASSIGN_OR_RETURN(json["radii"], PackNumbers(radii));
  if (sheets.labels.empty()) return json;
  BCCSKEL_ASSIGN_OR_RETURN(json["labels"], PackNumbers(sheets.labels));
  return json;
}

// The values in a list, ascending, each once.
std::vector<double> ValuesIn(const std::vector<double>& list) {
  const absl::flat_hash_set<double> known(list.begin(), list.end());
  std::vector<double> values(known.begin(), known.end());
  std::ranges::sort(values);
  return values;
}

// The points of all edges, one edge after the other. Coordinates have finer steps than those of
// surfaces, as a view of a single branch shows them; radii are exact.
absl::StatusOr<OrderedJson> CurvesJson(const ResultDocument& result, const Quantizer& surfaces,
                                       const exec::Context& context) {
  constexpr uint32_t kFineSteps = 1 << 22;
  const Quantizer quantize = {surfaces.low, surfaces.step * kSteps / kFineSteps};
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<WorldPoint> curves, DisplayCurvesOf(result, context));
  const std::vector<double> radii = ValuesIn(result.radii);
  std::vector<uint32_t> counts, coordinates(3 * curves.size()), ranks(curves.size());
  for (const ResultDocument::Edge& edge : result.edges) {
    counts.push_back(static_cast<uint32_t>(edge.point_count));
  }
  constexpr size_t kAtOnce = 1 << 14;
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(curves.size(), kAtOnce, [&](exec::Share share) {
    for (size_t n = share.begin; n < share.end; ++n) {
      for (size_t axis = 0; axis < 3; ++axis) {
        coordinates[axis * curves.size() + n] = quantize(curves[n][axis], axis);
      }
      const auto rank = std::ranges::lower_bound(radii, result.radii[n]) - radii.begin();
      ranks[n] = static_cast<uint32_t>(rank);
    }
  }));
  BCCSKEL_ASSIGN_OR_RETURN(std::string packed_counts, PackNumbers(counts, context));
  BCCSKEL_ASSIGN_OR_RETURN(std::string packed_ranks, PackNumbers(ranks, context));
  BCCSKEL_ASSIGN_OR_RETURN(std::string packed_coordinates, PackNumbers(coordinates, context));
  return OrderedJson{{"edges", counts.size()},
                     {"points", curves.size()},
                     {"counts", std::move(packed_counts)},
                     {"radii", radii},
                     {"ranks", std::move(packed_ranks)},
                     {"coordinates", std::move(packed_coordinates)}};
}

Front FrontOf(const PageContent& content) {
  if (content.peeling.layers.empty()) return FrontOf(content.result, {});
  return FrontOf(content.result, content.peeling.layers.front().surface.vertices);
}

OrderedJson FrontJson(const PageContent& content) {
  const auto [view, turn, climb] = FrontOf(content);
  return {{"right", view.right},
          {"up", view.up},
          {"toward", view.toward},
          {"turn", turn},
          {"climb", climb}};
}

// Names are text: numbers of 64 bits are too large for a script.
OrderedJson LabelsJson(const ResultDocument::Labels& labels) {
  OrderedJson json = {{"names", OrderedJson::array()}, {"of_nodes", labels.of_nodes}};
  for (const uint64_t name : labels.names) json["names"].push_back(std::to_string(name));
  return json;
}

absl::StatusOr<OrderedJson> DataOf(const PageContent& content, const exec::Context& context) {
  const Quantizer quantize = QuantizerFor(BoxOf(content));
  OrderedJson data = {{"title", content.title},
                      {"low", quantize.low},
                      {"step", quantize.step},
                      {"last_shell", content.peeling.last_shell},
                      {"layers", OrderedJson::array()}};
  for (const Peeled& layer : content.peeling.layers) {
    const auto& [vertices, triangles, of_labels] = layer.surface;
    BCCSKEL_ASSIGN_OR_RETURN(OrderedJson surface, SurfaceJson(vertices, triangles, quantize));
    surface["shells"] = layer.shells;
    if (!of_labels.empty()) surface["parts"] = of_labels;
    data["layers"].push_back(std::move(surface));
  }
  if (content.result.labels.has_value()) data["labels"] = LabelsJson(*content.result.labels);
  data["front"] = FrontJson(content);
  BCCSKEL_ASSIGN_OR_RETURN(data["curves"], CurvesJson(content.result, quantize, context));
  const SheetSurface sheets = SheetSurfaceOf(content.result);
  BCCSKEL_ASSIGN_OR_RETURN(data["sheets"], SheetsJson(sheets, quantize));
  return data;
}

OrderedJson BranchJson(const PrunedBranch& branch) {
  OrderedJson json = {{"source", branch.source},
                      {"target", branch.target},
                      {"length", branch.figures.length},
                      {"mean", branch.figures.mean_radius},
                      {"min", branch.figures.min_radius},
                      {"max", branch.figures.max_radius},
                      {"edges", branch.edges}};
  if (std::isfinite(branch.level)) json["level"] = branch.level;
  if (branch.shared) json["shared"] = true;
  return json;
}

OrderedJson PruningJson(const PruningSteps& pruning) {
  OrderedJson json = {{"nodes", OrderedJson::array()},
                      {"states", OrderedJson::array()},
                      {"branches", OrderedJson::array()},
                      {"steps", OrderedJson::array()}};
  for (const PrunedNode& node : pruning.nodes) {
    json["nodes"].push_back(
        {{"position", node.position}, {"radius", node.radius}, {"component", node.component}});
  }
  for (const NodeState& state : pruning.states) {
    json["states"].push_back({state.node, NodeKindName(state.kind)});
  }
  for (const PrunedBranch& branch : pruning.branches) {
    json["branches"].push_back(BranchJson(branch));
  }
  const auto change = [](const Change& c) { return OrderedJson{{"on", c.on}, {"off", c.off}}; };
  for (const PruningStep& step : pruning.steps) {
    json["steps"].push_back({{"level", step.level},
                             {"states", change(step.states)},
                             {"branches", change(step.branches)}});
  }
  return json;
}

// The document's text without what the page holds in another form.
absl::StatusOr<std::string> PackResult(const ResultDocument& document,
                                       const exec::Context& context) {
  const std::string_view text = *document.text;
  if (document.not_on_pages.empty()) return PackText(text, context);  // it may be large
  std::string shown;
  const char* from = text.data();
  for (const std::string_view left_out : document.not_on_pages) {
    shown.append(from, left_out.data());
    shown += "null";
    from = left_out.data() + left_out.size();
  }
  shown.append(from, text.data() + text.size());
  return PackText(shown, context);
}

// JSON for a script element, which no text in it may end.
std::string InScript(const std::string& json) {
  return absl::StrReplaceAll(json, {{"<", "\\u003c"}});
}

using Part = std::pair<std::string_view, std::string_view>;

// The frame with `{{name}}` replaced by the part of this name. Needs: the frame has all of them, in
// this order.
std::string Filled(std::string_view frame, const std::vector<Part>& parts) {
  size_t size = frame.size();
  for (const Part& part : parts) size += part.second.size();
  std::string page;
  page.reserve(size);
  for (const auto& [name, text] : parts) {
    const std::string mark = "{{" + std::string(name) + "}}";
    const size_t at = frame.find(mark);
    page.append(frame.substr(0, at)).append(text);
    frame.remove_prefix(at + mark.size());
  }
  return page.append(frame);
}

}  // namespace

absl::StatusOr<std::string> PageOf(const PageContent& content, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const OrderedJson data, DataOf(content, context));
  const std::string steps = PruningJson(PruningStepsOf(content.result, context)).dump();
  BCCSKEL_ASSIGN_OR_RETURN(const std::string pruning, PackText(steps, context));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string result, PackResult(content.result, context));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string three, PackText(kThree));
  const std::string data_text =
      InScript(data.dump(-1, ' ', /*ensure_ascii=*/false, OrderedJson::error_handler_t::replace));
  return Filled(kPageFrame, {{"style", kPageStyle},
                             {"license", kThreeLicense},
                             {"data", data_text},
                             {"pruning", pruning},
                             {"result", result},
                             {"three", three},
                             {"viewer", kViewerScripts},
                             {"loader", kLoaderScript}});
}

}  // namespace bccskel::view
