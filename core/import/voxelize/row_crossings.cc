#include "core/import/voxelize/row_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/import/voxelize/grid_fit.h"

namespace bccskel {
namespace {

constexpr int64_t kCellTicks = int64_t{2} << kTickBits;

int64_t FirstTick(Sublattice sublattice) { return static_cast<int64_t>(sublattice) << kTickBits; }

// The first cell at or behind a tick.
int32_t CellFrom(int64_t tick, Sublattice sublattice) {
  return static_cast<int32_t>(CeilDivide(tick - FirstTick(sublattice), kCellTicks));
}

CellSpan CellsIn(GridRange ticks, Sublattice sublattice) {
  return {CellFrom(ticks.begin, sublattice), CellFrom(ticks.end, sublattice)};
}

int64_t TickOf(int32_t cell, Sublattice sublattice) {
  return cell * kCellTicks + FirstTick(sublattice);
}

CellSpan ClipToSlab(CellSpan layers, Slab slab) {
  return {std::max(layers.begin, slab.begin_bz * kBrickZ),
          std::min(layers.end, slab.end_bz * kBrickZ)};
}

std::array<GridPoint, 3> Corners(const FillRequest& request, size_t triangle) {
  const auto& [a, b, c] = request.triangles[triangle];
  return {request.vertices[a], request.vertices[b], request.vertices[c]};
}

// Calls visit(row, first tick behind the crossing, winding) for every row of the slab that crosses.
template <typename Visit>
void ForEachCrossing(const FillRequest& request, size_t triangle, Slab slab, Visit visit) {
  const auto [a, b, c] = Corners(request, triangle);
  const RayTriangle shape(a, b, c);
  if (shape.parallel()) return;
  const auto winding = static_cast<int16_t>(shape.winding() * request.sign[triangle]);
  for (Sublattice sublattice : kSublattices) {
    const CellSpan layers = ClipToSlab(CellsIn(shape.Rows(), sublattice), slab);
    for (int32_t k = layers.begin; k < layers.end; ++k) {
      const int64_t z = TickOf(k, sublattice);
      const CellSpan columns = CellsIn(shape.CrossedColumns(z), sublattice);
      for (int32_t j = columns.begin; j < columns.end; ++j) {
        visit(LatticeRow{sublattice, j, k}, shape.FirstBehind(TickOf(j, sublattice), z), winding);
      }
    }
  }
}

}  // namespace

void AppendCrossings(const FillRequest& request, size_t triangle, Slab slab,
                     std::vector<RowCrossing>& crossings) {
  ForEachCrossing(request, triangle, slab, [&](LatticeRow row, int64_t x, int16_t winding) {
    crossings.push_back({RowKey(row), CellFrom(x, row.sublattice), winding, /*crossings=*/1});
  });
}

void AppendHits(const FillRequest& request, uint32_t triangle, Slab slab,
                std::vector<RowHit>& hits) {
  ForEachCrossing(request, triangle, slab, [&](LatticeRow row, int64_t x, int16_t winding) {
    hits.push_back({RowKey(row), x, triangle, winding});
  });
}

void AppendMarks(const SegmentRule::Region& region, Slab slab,
                 std::vector<RowCrossing>& crossings) {
  const CellSpan layers = ClipToSlab(region.k, slab);
  for (Sublattice sublattice : kSublattices) {
    for (int32_t k = layers.begin; k < layers.end; ++k) {
      for (int32_t j = region.j.begin; j < region.j.end; ++j) {
        const RowKey row({sublattice, j, k});
        crossings.push_back({row, region.i.begin, /*winding=*/0, /*crossings=*/0});
        crossings.push_back({row, region.i.end, /*winding=*/0, /*crossings=*/0});
      }
    }
  }
}

Slab LayersOf(const FillRequest& request, size_t triangle) {
  const auto [a, b, c] = Corners(request, triangle);
  const auto [low, high] = std::minmax({a.z, b.z, c.z});
  return {static_cast<int32_t>(low / kCellTicks) / kBrickZ,
          static_cast<int32_t>(high / kCellTicks) / kBrickZ + 1};
}

CrossingWork EstimateWork(const FillRequest& request, size_t triangle) {
  const auto [a, b, c] = Corners(request, triangle);
  const auto [low, high] = std::minmax({a.z, b.z, c.z});
  const auto wide = [](int64_t from, int64_t to) { return static_cast<double>(to - from); };
  const double area = std::abs(wide(a.y, b.y) * wide(a.z, c.z) - wide(a.z, b.z) * wide(a.y, c.y));
  constexpr double kTicks = static_cast<double>(kCellTicks);
  return {2 * wide(low, high) / kTicks, area / (kTicks * kTicks)};
}

}  // namespace bccskel
