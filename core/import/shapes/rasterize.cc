#include "core/import/shapes/rasterize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "absl/strings/str_format.h"

namespace bccskel::shapes {
namespace {

constexpr double kMarginUnits = 4;  // two cells

Bounds BoundsOfAll(std::span<const Solid> solids) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Bounds all = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const Solid& solid : solids) {
    const Bounds one = BoundsOf(solid);
    all.low = {std::min(all.low.x, one.low.x), std::min(all.low.y, one.low.y),
               std::min(all.low.z, one.low.z)};
    all.high = {std::max(all.high.x, one.high.x), std::max(all.high.y, one.high.y),
                std::max(all.high.z, one.high.z)};
  }
  return all;
}

// Cells of one row, first..last; none when first > last.
struct CellRange {
  int32_t first = std::numeric_limits<int32_t>::max();
  int32_t last = -1;

  void Include(CellRange other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
  // The cells of brick bx as bits of a 16-bit lane.
  uint64_t InBrick(int32_t bx) const {
    const int32_t low = std::max(first - bx * kBrickX, 0);
    const int32_t high = std::min(last - bx * kBrickX, kBrickX - 1);
    if (low > high) return 0;
    return (uint64_t{2} << high) - (uint64_t{1} << low);
  }
};

// The rows of one brick column (by, bz) of one sublattice, in the order of the brick's lanes. A row
// has at most two ranges.
constexpr size_t kRows = kBrickY * kBrickZ;
using ColumnRows = std::array<std::array<CellRange, 2>, kRows>;

class SolidRasterizer {
 public:
  SolidRasterizer(double scale, Vector shift, const ChooseLayer& chosen, VolumeBuilder& builder)
      : scale_(scale), shift_(shift), chosen_(chosen), builder_(builder) {}

  void Add(const Solid& solid) {
    const Bounds bounds = BoundsOf(solid);
    const Vector low = ToLattice(bounds.low), high = ToLattice(bounds.high);
    for (Sublattice sublattice : kSublattices) {
      for (int32_t bz = CellAt(low.z) / kBrickZ; bz <= CellAt(high.z) / kBrickZ; ++bz) {
        if (!chosen_(bz)) continue;
        for (int32_t by = CellAt(low.y) / kBrickY; by <= CellAt(high.y) / kBrickY; ++by) {
          AddColumn(solid, {0, by, bz, sublattice});
        }
      }
    }
  }

 private:
  Vector ToLattice(Vector figure) const { return scale_ * figure + shift_; }
  static int32_t CellAt(double lattice) { return static_cast<int32_t>(std::floor(lattice / 2)); }

  void AddColumn(const Solid& solid, BrickCoordinates column) {
    ColumnRows rows;
    CellRange all;
    for (size_t row = 0; row < kRows; ++row) {
      const LatticePoint p = PointOf(column, static_cast<int>(row) * kBrickX);
      const RowSpans spans = SpansAt(solid, (p.y - shift_.y) / scale_, (p.z - shift_.z) / scale_);
      for (size_t n = 0; n < spans.size(); ++n) {
        if (spans[n].empty()) continue;
        rows[row][n] = CellsOf(spans[n], column.sublattice);
        if (rows[row][n].first <= rows[row][n].last) all.Include(rows[row][n]);
      }
    }
    if (all.first > all.last) return;
    for (column.bx = all.first / kBrickX; column.bx <= all.last / kBrickX; ++column.bx) {
      AddBrick(column, rows);
    }
  }

  CellRange CellsOf(Span span, Sublattice sublattice) const {
    const double odd = static_cast<double>(sublattice);
    const double first = std::ceil((span.low * scale_ + shift_.x - odd) / 2);
    const double last = std::floor((span.high * scale_ + shift_.x - odd) / 2);
    return {static_cast<int32_t>(first), static_cast<int32_t>(last)};
  }

  void AddBrick(BrickCoordinates coordinates, const ColumnRows& rows) {
    BrickBits bits;
    for (size_t row = 0; row < kRows; ++row) {
      const uint64_t lane =
          rows[row][0].InBrick(coordinates.bx) | rows[row][1].InBrick(coordinates.bx);
      bits.words[row / kBrickY] |= lane << (kBrickX * (row % kBrickY));
    }
    if (bits.Empty()) return;
    BrickBits& target = builder_.Brick(BrickKey(coordinates));
    for (size_t k = 0; k < bits.words.size(); ++k) target.words[k] |= bits.words[k];
  }

  const double scale_;
  const Vector shift_;
  const ChooseLayer& chosen_;
  VolumeBuilder& builder_;
};

}  // namespace

absl::StatusOr<Volume> Rasterize(std::span<const Solid> solids, double scale) {
  return RasterizeLayers(solids, scale, [](int32_t) { return true; });
}

absl::StatusOr<Volume> RasterizeLayers(std::span<const Solid> solids, double scale,
                                       const ChooseLayer& chosen) {
  const Bounds bounds = BoundsOfAll(solids);
  const Vector size = scale * (bounds.high - bounds.low) +
                      Vector{2 * kMarginUnits, 2 * kMarginUnits, 2 * kMarginUnits};
  if (std::max({size.x, size.y, size.z}) > 2.0 * kMaxExtentCells) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the figure needs %.0f x %.0f x %.0f cells: each axis must have 1 to %d",
                        size.x / 2, size.y / 2, size.z / 2, kMaxExtentCells));
  }
  const auto cells = [](double units) { return static_cast<int32_t>(std::ceil(units / 2)); };
  VolumeBuilder builder({cells(size.x), cells(size.y), cells(size.z)});
  const Vector margin = {kMarginUnits, kMarginUnits, kMarginUnits};
  SolidRasterizer rasterizer(scale, margin - scale * bounds.low, chosen, builder);
  for (const Solid& solid : solids) rasterizer.Add(solid);
  return std::move(builder).Build();
}

}  // namespace bccskel::shapes
