#include "client/export/vtp.h"

#include <string_view>
#include <utility>
#include <vector>

#include "client/export/polylines.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

// One <DataArray>, its values separated by line ends.
template <typename WriteValues>
void AddArray(Text& text, std::string_view type, std::string_view name, WriteValues write_values) {
  text.Add("<DataArray type=\"", type, "\" Name=\"", name, "\" format=\"ascii\">\n");
  write_values();
  text.Add("</DataArray>\n");
}

void AddPoints(Text& text, const SkeletonGraph& graph, const Polylines& polylines) {
  text.Add("<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" ",
           "format=\"ascii\">\n");
  for (const SkeletonPoint& point : polylines.points) {
    const WorldPoint p = graph.PositionOf(point);
    text.Add(p[0], ' ', p[1], ' ', p[2], '\n');
  }
  text.Add("</DataArray>\n</Points>\n");
}

void AddCells(Text& text, std::string_view tag, const std::vector<std::vector<size_t>>& cells) {
  text.Add('<', tag, ">\n");
  AddArray(text, "Int64", "connectivity", [&] {
    for (const std::vector<size_t>& cell : cells) {
      for (size_t n : cell) text.Add(n, ' ');
      text.Add('\n');
    }
  });
  AddArray(text, "Int64", "offsets", [&] {
    size_t end = 0;
    for (const std::vector<size_t>& cell : cells) text.Add(end += cell.size(), '\n');
  });
  text.Add("</", tag, ">\n");
}

// The places of the points on smooth curves, in the order of Polylines::points.
std::vector<WorldPoint> SmoothPoints(const SkeletonGraph& graph) {
  std::vector<WorldPoint> places;
  for (const SkeletonNode& node : graph.nodes) places.push_back(graph.PositionOf(node.at));
  for (const SkeletonEdge& edge : graph.edges) {
    const std::vector<WorldPoint> curve = SmoothCurve(graph, edge);
    if (curve.empty()) continue;
    if (graph.nodes[edge.source].kind == NodeKind::kLoop) places[edge.source] = curve.front();
    if (curve.size() > 2) places.insert(places.end(), curve.begin() + 1, curve.end() - 1);
  }
  return places;
}

void AddPointData(Text& text, const SkeletonGraph& graph, const Polylines& polylines) {
  text.Add("<PointData Scalars=\"radius\">\n");
  AddArray(text, "Float64", "radius", [&] {
    for (const SkeletonPoint& p : polylines.points) text.Add(graph.RadiusOf(p), '\n');
  });
  AddArray(text, "Float64", "distance", [&] {
    for (const SkeletonPoint& p : polylines.points) text.Add(p.radius, '\n');
  });
  AddArray(text, "UInt8", "node_kind", [&] {
    for (size_t n = 0; n < polylines.points.size(); ++n) {
      text.Add(n < graph.nodes.size() ? 1 + static_cast<int>(graph.nodes[n].kind) : 0, '\n');
    }
  });
  text.Add("<DataArray type=\"Float64\" Name=\"smooth\" NumberOfComponents=\"3\" ",
           "format=\"ascii\">\n");
  for (const WorldPoint& p : SmoothPoints(graph)) text.Add(p[0], ' ', p[1], ' ', p[2], '\n');
  text.Add("</DataArray>\n</PointData>\n");
}

void AddLabels(Text& text, const GraphLabels& labels, const Polylines& polylines) {
  AddArray(text, "UInt64", "label", [&] {
    for (size_t n : polylines.lone_nodes) text.Add(labels.of_nodes[n], '\n');
    for (uint64_t label : labels.of_edges) text.Add(label, '\n');
  });
}

void AddCellData(Text& text, const SkeletonGraph& graph, const Polylines& polylines,
                 const GraphLabels& labels) {
  text.Add("<CellData Scalars=\"edge_id\">\n");
  AddArray(text, "Int64", "edge_id", [&] {
    for (size_t n = 0; n < polylines.lone_nodes.size(); ++n) text.Add("-1\n");
    for (size_t n = 0; n < graph.edges.size(); ++n) text.Add(n, '\n');
  });
  std::vector<EdgeFigures> figures;
  for (const SkeletonEdge& edge : graph.edges) figures.push_back(FiguresOf(graph, edge));
  const auto add = [&](std::string_view name, auto figure) {
    AddArray(text, "Float64", name, [&] {
      for (size_t n = 0; n < polylines.lone_nodes.size(); ++n) text.Add("0\n");
      for (const EdgeFigures& one : figures) text.Add(figure(one), '\n');
    });
  };
  add("length", [](const EdgeFigures& one) { return one.length; });
  add("mean_radius", [](const EdgeFigures& one) { return one.mean_radius; });
  add("min_radius", [](const EdgeFigures& one) { return one.min_radius; });
  add("max_radius", [](const EdgeFigures& one) { return one.max_radius; });
  add("tortuosity", [](const EdgeFigures& one) { return one.tortuosity.value_or(0); });
  if (!labels.of_nodes.empty()) AddLabels(text, labels, polylines);
  text.Add("</CellData>\n");
}

}  // namespace

std::string VtpText(const SkeletonGraph& graph, const GraphLabels& labels) {
  const Polylines polylines = PolylinesOf(graph);
  std::vector<std::vector<size_t>> vertices;
  for (size_t n : polylines.lone_nodes) vertices.push_back({n});
  Text text;
  text.Add("<?xml version=\"1.0\"?>\n<!-- curve skeleton by bccskel -->\n",
           "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" ",
           "header_type=\"UInt64\">\n<PolyData>\n");
  text.Add("<Piece NumberOfPoints=\"", polylines.points.size(), "\" NumberOfVerts=\"",
           vertices.size(), "\" NumberOfLines=\"", polylines.lines.size(),
           "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n");
  AddPointData(text, graph, polylines);
  AddCellData(text, graph, polylines, labels);
  AddPoints(text, graph, polylines);
  AddCells(text, "Verts", vertices);
  AddCells(text, "Lines", polylines.lines);
  text.Add("</Piece>\n</PolyData>\n</VTKFile>\n");
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
