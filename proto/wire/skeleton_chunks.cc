#include "proto/wire/skeleton_chunks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/enumerators.h"
#include "proto/wire/result.h"

namespace bccskel::wire {
namespace {

// The largest size of a row: 5 bytes for each 32-bit varint, 3 for a 16-bit one, 4 for a float, 8
// for a double, 10 for a 64-bit one, 1 for a kind.
constexpr size_t kNodeRowBytes = 1 + 7 * 5;
constexpr size_t kEdgeRowBytes = 2 * 5 + 10 + 8;
constexpr size_t kPointRowBytes = 5 * 5 + 3 * 3;
// Tags and lengths of the tables and their columns, and the sequence number.
constexpr size_t kFramingBytes = 256;

// More points than any lattice has; prevents overflow in sums of hostile counts.
constexpr uint64_t kMaxEdgePoints = uint64_t{1} << 62;

// The number of `left` rows that fit; subtracts their bytes from the budget.
size_t TakeRows(size_t left, size_t row_bytes, size_t& budget_bytes) {
  const size_t rows = std::min(left, budget_bytes / row_bytes);
  budget_bytes -= rows * row_bytes;
  return rows;
}

constexpr std::pair<v1::SkeletonNodeKind, NodeKind> kNodeKinds[] = {
    {v1::SKELETON_NODE_KIND_END, NodeKind::kEnd},
    {v1::SKELETON_NODE_KIND_JUNCTION, NodeKind::kJunction},
    {v1::SKELETON_NODE_KIND_LOOP, NodeKind::kLoop},
    {v1::SKELETON_NODE_KIND_ISOLATED, NodeKind::kIsolated},
    {v1::SKELETON_NODE_KIND_CLOSED_SURFACE, NodeKind::kClosedSurface}};

template <typename Columns>
void AppendPoint(const SkeletonPoint& point, Columns& columns) {
  columns.add_x(point.point.x);
  columns.add_y(point.point.y);
  columns.add_z(point.point.z);
  columns.add_radius(point.radius);
}

template <typename Columns>
SkeletonPoint PointOfRow(const Columns& columns, int row) {
  const uint32_t birth = columns.birth_size() == 0 ? 0 : columns.birth(row);
  return {{columns.x(row), columns.y(row), columns.z(row)},
          columns.radius(row),
          static_cast<int32_t>(std::min<uint32_t>(birth, INT32_MAX))};
}

uint32_t BirthInMessage(const SkeletonPoint& point) { return static_cast<uint32_t>(point.birth); }

void AppendShift(const SkeletonPoint& point, v1::SkeletonPointColumns& columns) {
  columns.add_shift_x(point.shift[0]);
  columns.add_shift_y(point.shift[1]);
  columns.add_shift_z(point.shift[2]);
}

// Clamps invalid shifts to the nearest valid one.
std::array<int16_t, 3> ShiftOfRow(const v1::SkeletonPointColumns& columns, int row) {
  const auto part = [](int32_t v) {
    return static_cast<int16_t>(std::clamp<int32_t>(v, INT16_MIN, INT16_MAX));
  };
  return {part(columns.shift_x(row)), part(columns.shift_y(row)), part(columns.shift_z(row))};
}

// The number of rows of an optional column.
int RowsOf(int column, int table) { return column == 0 ? table : column; }

absl::Status CheckColumns(const char* table, std::initializer_list<int> sizes) {
  for (int size : sizes) {
    if (size != *sizes.begin()) {
      return absl::DataLossError(absl::StrCat("the skeleton's ", table, " table has columns of ",
                                              *sizes.begin(), " and ", size, " rows"));
    }
  }
  return absl::OkStatus();
}

absl::Status AppendNodes(const v1::SkeletonNodeColumns& c, SkeletonGraph& graph) {
  BCCSKEL_RETURN_IF_ERROR(CheckColumns(
      "node", {c.kind_size(), c.x_size(), c.y_size(), c.z_size(), c.radius_size(), c.loops_size(),
               c.cavities_size(), RowsOf(c.birth_size(), c.kind_size())}));
  for (int row = 0; row < c.kind_size(); ++row) {
    const std::optional<NodeKind> kind =
        MeaningOf(static_cast<v1::SkeletonNodeKind>(c.kind(row)), kNodeKinds);
    if (!kind.has_value()) {
      return absl::DataLossError(absl::StrCat("unknown skeleton node kind ", int{c.kind(row)}));
    }
    graph.nodes.push_back({*kind, PointOfRow(c, row), c.loops(row), c.cavities(row)});
  }
  return absl::OkStatus();
}

absl::Status CheckEdgeColumns(const v1::SkeletonEdgeColumns& c) {
  return CheckColumns("edge", {c.source_size(), c.target_size(), c.point_count_size(),
                               RowsOf(c.pruning_level_size(), c.source_size())});
}

absl::Status AppendPoints(const v1::SkeletonPointColumns& c, std::vector<SkeletonPoint>& points) {
  BCCSKEL_RETURN_IF_ERROR(CheckColumns(
      "point", {c.x_size(), c.y_size(), c.z_size(), c.radius_size(),
                RowsOf(c.birth_size(), c.x_size()), RowsOf(c.shift_x_size(), c.x_size())}));
  BCCSKEL_RETURN_IF_ERROR(
      CheckColumns("point", {c.shift_x_size(), c.shift_y_size(), c.shift_z_size()}));
  for (int row = 0; row < c.x_size(); ++row) {
    points.push_back(PointOfRow(c, row));
    if (c.shift_x_size() > 0) points.back().shift = ShiftOfRow(c, row);
  }
  return absl::OkStatus();
}

absl::Status CheckCount(const char* table, uint64_t received, uint64_t stated) {
  if (received == stated) return absl::OkStatus();
  return absl::DataLossError(
      absl::StrCat("received ", received, " skeleton ", table, ", the summary states ", stated));
}

absl::Status CheckEdge(const SkeletonGraph& graph, size_t n) {
  const SkeletonEdge& edge = graph.edges[n];
  if (edge.source >= graph.nodes.size() || edge.target >= graph.nodes.size()) {
    return absl::DataLossError(absl::StrCat("edge ", n, " leads from node ", edge.source, " to ",
                                            edge.target, " of ", graph.nodes.size()));
  }
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  if (points.empty() || points.front().point != graph.nodes[edge.source].at.point ||
      points.back().point != graph.nodes[edge.target].at.point) {
    return absl::DataLossError(
        absl::StrCat("the points of edge ", n, " do not run from its source to its target"));
  }
  if (!(edge.pruning_level >= 0)) {
    return absl::DataLossError(absl::StrCat("edge ", n, " has pruning level ", edge.pruning_level));
  }
  return absl::OkStatus();
}

absl::Status CheckRadius(float radius) {
  if (radius >= 0 && std::isfinite(radius)) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("a radius of ", radius));
}

absl::Status CheckGraph(const SkeletonGraph& graph, uint64_t edge_points,
                        const v1::SkeletonSummary& summary) {
  BCCSKEL_RETURN_IF_ERROR(CheckCount("nodes", graph.nodes.size(), summary.node_count()));
  BCCSKEL_RETURN_IF_ERROR(CheckCount("edges", graph.edges.size(), summary.edge_count()));
  BCCSKEL_RETURN_IF_ERROR(CheckCount("points", graph.points.size(), summary.point_count()));
  BCCSKEL_RETURN_IF_ERROR(CheckCount("points of edges", edge_points, summary.point_count()));
  BCCSKEL_RETURN_IF_ERROR(
      CheckCount("points of sheets", graph.sheets.size(), summary.sheet_point_count()));
  for (size_t n = 0; n < graph.edges.size(); ++n) {
    BCCSKEL_RETURN_IF_ERROR(CheckEdge(graph, n));
  }
  for (const SkeletonNode& node : graph.nodes) {
    BCCSKEL_RETURN_IF_ERROR(CheckRadius(node.at.radius));
  }
  for (const std::vector<SkeletonPoint>* points : {&graph.points, &graph.sheets}) {
    for (const SkeletonPoint& point : *points) {
      BCCSKEL_RETURN_IF_ERROR(CheckRadius(point.radius));
    }
  }
  return absl::OkStatus();
}

}  // namespace

SkeletonChunkPager::SkeletonChunkPager(const SkeletonGraph& graph)
    : graph_(&graph),
      births_(graph.HasBirths() ? Births::kSome : Births::kNone),
      shifts_(graph.HasShifts() ? Shifts::kSome : Shifts::kNone) {}

std::optional<v1::SkeletonChunk> SkeletonChunkPager::Next() {
  if (AtEnd() && sequence_ > 0) return std::nullopt;
  v1::SkeletonChunk chunk;
  chunk.set_sequence(sequence_++);
  size_t budget_bytes = kMaxSkeletonChunkBytes - kFramingBytes;
  AddNodes(budget_bytes, *chunk.mutable_nodes());
  if (node_ == graph_->nodes.size()) AddEdges(budget_bytes, *chunk.mutable_edges());
  if (edge_ == graph_->edges.size()) AddPoints(budget_bytes, *chunk.mutable_points());
  if (points_edge_ == graph_->edges.size()) AddSheets(budget_bytes, *chunk.mutable_sheets());
  return chunk;
}

bool SkeletonChunkPager::AtEnd() const {
  return node_ == graph_->nodes.size() && points_edge_ == graph_->edges.size() &&
         sheet_point_ == graph_->sheets.size();
}

void SkeletonChunkPager::AddNodes(size_t& budget_bytes, v1::SkeletonNodeColumns& columns) {
  for (size_t rows = TakeRows(graph_->nodes.size() - node_, kNodeRowBytes, budget_bytes); rows > 0;
       --rows) {
    const SkeletonNode& node = graph_->nodes[node_++];
    columns.add_kind(EnumeratorOf(node.kind, kNodeKinds));
    AppendPoint(node.at, columns);
    if (births_ == Births::kSome) columns.add_birth(BirthInMessage(node.at));
    columns.add_loops(node.loops);
    columns.add_cavities(node.cavities);
  }
}

void SkeletonChunkPager::AddEdges(size_t& budget_bytes, v1::SkeletonEdgeColumns& columns) {
  for (size_t rows = TakeRows(graph_->edges.size() - edge_, kEdgeRowBytes, budget_bytes); rows > 0;
       --rows) {
    const SkeletonEdge& edge = graph_->edges[edge_++];
    columns.add_source(edge.source);
    columns.add_target(edge.target);
    columns.add_point_count(edge.point_count);
    columns.add_pruning_level(edge.pruning_level);
  }
}

void SkeletonChunkPager::AddPoints(size_t& budget_bytes, v1::SkeletonPointColumns& columns) {
  while (points_edge_ < graph_->edges.size()) {
    const auto points = graph_->PointsOf(graph_->edges[points_edge_]).subspan(edge_point_);
    const size_t rows = TakeRows(points.size(), kPointRowBytes, budget_bytes);
    for (const SkeletonPoint& point : points.first(rows)) {
      AppendPoint(point, columns);
      if (births_ == Births::kSome) columns.add_birth(BirthInMessage(point));
      if (shifts_ == Shifts::kSome) AppendShift(point, columns);
    }
    edge_point_ += rows;
    if (rows < points.size()) return;
    ++points_edge_;
    edge_point_ = 0;
  }
}

void SkeletonChunkPager::AddSheets(size_t& budget_bytes, v1::SkeletonPointColumns& columns) {
  for (size_t rows = TakeRows(graph_->sheets.size() - sheet_point_, kPointRowBytes, budget_bytes);
       rows > 0; --rows) {
    const SkeletonPoint& point = graph_->sheets[sheet_point_++];
    AppendPoint(point, columns);
    if (births_ == Births::kSome) columns.add_birth(BirthInMessage(point));
  }
}

absl::Status SkeletonAssembler::Add(const v1::SkeletonChunk& chunk) {
  if (chunk.sequence() != chunks_) {
    return absl::DataLossError(
        absl::StrCat("received skeleton chunk ", chunk.sequence(), " instead of ", chunks_));
  }
  ++chunks_;
  const v1::SkeletonEdgeColumns& edges = chunk.edges();
  BCCSKEL_RETURN_IF_ERROR(AppendNodes(chunk.nodes(), graph_));
  BCCSKEL_RETURN_IF_ERROR(CheckEdgeColumns(edges));
  for (int row = 0; row < edges.source_size(); ++row) {
    if (edges.point_count(row) > kMaxEdgePoints - edge_points_) {
      return absl::DataLossError(absl::StrCat("an edge of ", edges.point_count(row),
                                              " points after ", edge_points_,
                                              " points, the limit is ", kMaxEdgePoints));
    }
    graph_.edges.push_back(
        {edges.source(row), edges.target(row), edge_points_, edges.point_count(row)});
    if (edges.pruning_level_size() > 0) {
      graph_.edges.back().pruning_level = edges.pruning_level(row);
    }
    edge_points_ += edges.point_count(row);
  }
  BCCSKEL_RETURN_IF_ERROR(AppendPoints(chunk.points(), graph_.points));
  return AppendPoints(chunk.sheets(), graph_.sheets);
}

absl::StatusOr<SkeletonizeResult> SkeletonAssembler::Finish(const v1::SkeletonSummary& summary) && {
  BCCSKEL_ASSIGN_OR_RETURN(SkeletonizeResult result, FromMessage(summary));
  BCCSKEL_RETURN_IF_ERROR(CheckGraph(graph_, edge_points_, summary));
  graph_.placement = result.graph.placement;
  result.graph = std::move(graph_);
  BCCSKEL_ASSIGN_OR_RETURN(const std::string digest, SkeletonDigest(result.graph));
  if (digest != result.sha256) {
    return absl::DataLossError(absl::StrCat("the received skeleton has the digest ", digest,
                                            ", the summary states ", result.sha256));
  }
  return result;
}

}  // namespace bccskel::wire
