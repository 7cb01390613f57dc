#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "client/export/graph_formats.h"
#include "client/export/picture/escape.h"
#include "client/export/polylines.h"
#include "client/export/text.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

// One <DataArray> with one value per line.
template <typename WriteValues>
void AddArray(Text& text, std::string_view type, std::string_view name, WriteValues write_values) {
  if (text.stopped()) return;
  text.Add("<DataArray type=\"", type, "\" Name=\"", name, "\" format=\"ascii\">\n");
  write_values();
  text.Add("</DataArray>\n");
}

void AddPlaces(Text& text, std::string_view name, const std::vector<WorldPoint>& places) {
  text.Add("<DataArray type=\"Float64\" Name=\"", name, "\" NumberOfComponents=\"3\" ",
           "format=\"ascii\">\n");
  for (const WorldPoint& p : places) {
    if (text.stopped()) return;
    text.Add(p[0], ' ', p[1], ' ', p[2], '\n');
  }
  text.Add("</DataArray>\n");
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

void AddPointData(Text& text, const SkeletonGraph& graph, const Polylines& polylines) {
  text.Add("<PointData Scalars=\"radius\">\n");
  AddArray(text, "Float64", "radius", [&] {
    for (const SkeletonPoint& p : polylines.points) text.Add(graph.RadiusOf(p), '\n');
  });
  AddArray(text, "Float64", "distance", [&] {
    for (const SkeletonPoint& p : polylines.points) text.Add(p.radius, '\n');
  });
  if (graph.HasBirths()) {
    AddArray(text, "Int32", "birth", [&] {
      for (const SkeletonPoint& p : polylines.points) text.Add(p.birth, '\n');
    });
  }
  AddArray(text, "UInt8", "node_kind", [&] {
    for (size_t n = 0; n < polylines.points.size(); ++n) {
      text.Add(n < graph.nodes.size() ? 1 + static_cast<int>(graph.nodes[n].kind) : 0, '\n');
    }
  });
  std::vector<WorldPoint> lattice;
  for (const SkeletonPoint& p : polylines.points) lattice.push_back(graph.PositionOf(p));
  AddPlaces(text, "lattice", lattice);
  text.Add("</PointData>\n");
}

void AddLabels(Text& text, const GraphLabels& labels, const Polylines& polylines) {
  AddArray(text, "UInt64", "label", [&] {
    for (size_t n : polylines.lone_points) {
      const size_t first = polylines.first_of_sheets;
      text.Add(n < first ? labels.of_nodes[n] : labels.of_sheets[n - first], '\n');
    }
    for (uint64_t label : labels.of_edges) text.Add(label, '\n');
  });
}

// Strings are written as the numbers of their characters.
void AddFacts(Text& text, const MethodFacts& facts) {
  if (facts.empty()) return;
  text.Add("<FieldData>\n");
  for (const auto& [name, value] : facts) {
    text.Add("<DataArray type=\"String\" Name=\"", EscapeMarkup(name),
             "\" NumberOfTuples=\"1\" format=\"ascii\">\n");
    for (char c : value) text.Add(static_cast<int>(static_cast<unsigned char>(c)), ' ');
    text.Add("0\n</DataArray>\n");
  }
  text.Add("</FieldData>\n");
}

// One value per cell; calls `value` for each edge.
template <typename Value>
void AddEdgeArray(Text& text, std::string_view type, std::string_view name,
                  std::string_view of_vertices, const SkeletonGraph& graph,
                  const Polylines& polylines, Value value) {
  AddArray(text, type, name, [&] {
    for (size_t n = 0; n < polylines.lone_points.size(); ++n) text.Add(of_vertices, '\n');
    for (size_t n = 0; n < graph.edges.size(); ++n) text.Add(value(n), '\n');
  });
}

void AddOrder(Text& text, const SkeletonGraph& graph, const Polylines& polylines,
              const TreeOrder& order) {
  const auto or_none = [&](uint32_t EdgeOrder::*number) {
    return [&order, number](size_t n) {
      const EdgeOrder& edge = order.edges[n];
      return edge.ClosesLoop() ? int64_t{-1} : static_cast<int64_t>(edge.*number);
    };
  };
  AddEdgeArray(text, "Int32", "generation", "-1", graph, polylines,
               or_none(&EdgeOrder::generation));
  AddEdgeArray(text, "Int32", "strahler", "-1", graph, polylines, or_none(&EdgeOrder::strahler));
  AddEdgeArray(text, "Int32", "along", "0", graph, polylines,
               [&](size_t n) { return order.edges[n].proximal == graph.edges[n].source ? 1 : 0; });
  AddEdgeArray(text, "Float64", "root_distance", "0", graph, polylines, [&](size_t n) {
    const SkeletonEdge& edge = graph.edges[n];
    return std::min(order.nodes[edge.source].root_distance, order.nodes[edge.target].root_distance);
  });
}

void AddCellData(Text& text, const SkeletonGraph& graph, const Polylines& polylines,
                 const GraphContext& context) {
  text.Add("<CellData Scalars=\"edge_id\">\n");
  AddArray(text, "Int64", "edge_id", [&] {
    for (size_t n = 0; n < polylines.lone_points.size(); ++n) text.Add("-1\n");
    for (size_t n = 0; n < graph.edges.size(); ++n) text.Add(n, '\n');
  });
  std::vector<EdgeFigures> figures;
  for (const SkeletonEdge& edge : graph.edges) {
    if (text.stopped()) return;
    figures.push_back(FiguresOf(graph, edge));
  }
  const auto add = [&](std::string_view name, auto figure) {
    AddArray(text, "Float64", name, [&] {
      for (size_t n = 0; n < polylines.lone_points.size(); ++n) text.Add("0\n");
      for (const EdgeFigures& one : figures) text.Add(figure(one), '\n');
    });
  };
  add("length", [](const EdgeFigures& one) { return one.length; });
  add("mean_radius", [](const EdgeFigures& one) { return one.mean_radius; });
  add("min_radius", [](const EdgeFigures& one) { return one.min_radius; });
  add("max_radius", [](const EdgeFigures& one) { return one.max_radius; });
  add("tortuosity", [](const EdgeFigures& one) { return one.tortuosity.value_or(0); });
  AddEdgeArray(text, "Float64", "pruning_level", "-1", graph, polylines, [&](size_t n) {
    const double level = graph.edges[n].pruning_level;
    return std::isfinite(level) ? level : -1.0;
  });
  if (!context.labels.of_nodes.empty()) AddLabels(text, context.labels, polylines);
  if (context.order.has_value()) AddOrder(text, graph, polylines, *context.order);
  text.Add("</CellData>\n");
}

}  // namespace

std::string VtpText(const SkeletonGraph& graph, const GraphContext& context) {
  const Polylines polylines = PolylinesOf(graph, context.exec.stop);
  std::vector<std::vector<size_t>> vertices;
  for (size_t n : polylines.lone_points) vertices.push_back({n});
  Text text(context.exec.stop);
  text.Add("<?xml version=\"1.0\"?>\n<!-- curve skeleton by bccskel -->\n",
           "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" ",
           "header_type=\"UInt64\">\n<PolyData>\n");
  AddFacts(text, context.facts);
  text.Add("<Piece NumberOfPoints=\"", polylines.points.size(), "\" NumberOfVerts=\"",
           vertices.size(), "\" NumberOfLines=\"", polylines.lines.size(),
           "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n");
  AddPointData(text, graph, polylines);
  AddCellData(text, graph, polylines, context);
  text.Add("<Points>\n");
  AddPlaces(text, "Points", polylines.places);
  text.Add("</Points>\n");
  AddCells(text, "Verts", vertices);
  AddCells(text, "Lines", polylines.lines);
  text.Add("</Piece>\n</PolyData>\n</VTKFile>\n");
  return std::move(text).Take();
}

}  // namespace bccskel::exporting
