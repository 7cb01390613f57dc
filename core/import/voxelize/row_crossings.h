#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_ROW_CROSSINGS_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_ROW_CROSSINGS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "core/import/voxelize/row_fill.h"

namespace bccskel {

// A row packed so that rows of one tube of bricks (same by and bz, both sublattices) follow each
// other: bz, by, then sublattice, k and j within the brick.
class RowKey {
 public:
  static constexpr size_t kRowsOfTube = 64;

  explicit RowKey(LatticeRow row)
      : value_(static_cast<uint64_t>(row.k >> 3) << 26 | static_cast<uint64_t>(row.j >> 2) << 6 |
               static_cast<uint64_t>(row.sublattice) << 5 | static_cast<uint64_t>(row.k & 7) << 2 |
               static_cast<uint64_t>(row.j & 3)) {}

  int32_t bz() const { return static_cast<int32_t>(value_ >> 26); }
  int32_t by() const { return static_cast<int32_t>(value_ >> 6 & 0xFFFFF); }
  size_t in_tube() const { return value_ & (kRowsOfTube - 1); }
  LatticeRow row() const {
    return {static_cast<Sublattice>(value_ >> 5 & 1),
            static_cast<int32_t>((value_ >> 6 & 0xFFFFF) << 2 | (value_ & 3)),
            static_cast<int32_t>((value_ >> 26) << 3 | (value_ >> 2 & 7))};
  }
  friend auto operator<=>(const RowKey&, const RowKey&) = default;

 private:
  uint64_t value_;
};

// Where a row crosses the surface: the first cell behind the crossing.
struct RowCrossing {
  RowKey row;
  int32_t cell = 0;
  int16_t winding = 0;    // added to the winding number
  int16_t crossings = 1;  // 0 for a mark that only cuts a segment
};

// The same, exactly.
struct RowHit {
  RowKey row;
  int64_t x = 0;  // the first tick behind the crossing
  uint32_t triangle = 0;
  int16_t winding = 0;
};

// A half-open range of layers of bricks.
struct Slab {
  int32_t begin_bz = 0;
  int32_t end_bz = 0;
};

// Appends the crossings of one triangle with the rows of the slab.
void AppendCrossings(const FillRequest& request, size_t triangle, Slab slab,
                     std::vector<RowCrossing>& crossings);

// The same as hits.
void AppendHits(const FillRequest& request, uint32_t triangle, Slab slab,
                std::vector<RowHit>& hits);

// Appends marks at both ends of the region's rows in the slab.
void AppendMarks(const SegmentRule::Region& region, Slab slab, std::vector<RowCrossing>& crossings);

// The layers of bricks that the triangle may reach.
Slab LayersOf(const FillRequest& request, size_t triangle);

// How much work the triangle will be: rows it spans in height and rows it crosses.
struct CrossingWork {
  double rows = 0;
  double crossings = 0;
};
CrossingWork EstimateWork(const FillRequest& request, size_t triangle);
// Whether the rows of the request are few enough, with `others` further crossings.
// Errors: RESOURCE_EXHAUSTED.
absl::Status CheckCrossingWork(const FillRequest& request, double others);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_ROW_CROSSINGS_H_
