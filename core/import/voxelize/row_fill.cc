#include "core/import/voxelize/row_fill.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/voxelize/row_crossings.h"
#include "core/import/voxelize/slab_plan.h"

namespace bccskel {
namespace {

// Bounds on the work, far above what real meshes need: a hostile one is refused, not served.
constexpr double kMaxRows = 4e9;
constexpr double kMaxCrossings = 1 << 27;
constexpr size_t kTrianglesBetweenStops = 1 << 14;

// The crossings of the marks at both ends of the rows in the regions.
double CrossingsOf(std::span<const SegmentRule::Region> regions) {
  double crossings = 0;
  for (const SegmentRule::Region& region : regions) {
    crossings += 4.0 * (region.j.end - region.j.begin) * (region.k.end - region.k.begin);
  }
  return crossings;
}

}  // namespace

absl::Status CheckCrossingWork(const FillRequest& request, double others) {
  CrossingWork total = {.crossings = others};
  for (size_t t = 0; t < request.triangles.size(); ++t) {
    const CrossingWork work = EstimateWork(request, t);
    total.rows += work.rows;
    total.crossings += work.crossings;
  }
  if (total.rows <= kMaxRows && total.crossings <= kMaxCrossings) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrFormat("lattice rows cross the surface about %.3g times (limit %.3g; triangles span "
                      "%.3g rows, limit "
                      "%.3g): choose a larger spacing or fewer points",
                      total.crossings, kMaxCrossings, total.rows, kMaxRows));
}

namespace {

// Bricks in the order of their keys.
struct BrickList {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
};

// Crossings in the order of a few buckets, and where each of these begins.
class Buckets {
 public:
  template <typename BucketOf>
  void Sort(std::span<const RowCrossing> crossings, size_t buckets, BucketOf bucket_of) {
    begin_.assign(buckets + 2, 0);
    for (const RowCrossing& c : crossings) ++begin_[bucket_of(c.row) + 2];
    for (size_t n = 2; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
    sorted_.assign(crossings.begin(), crossings.end());
    for (const RowCrossing& c : crossings) sorted_[begin_[bucket_of(c.row) + 1]++] = c;
  }

  size_t size() const { return begin_.size() - 2; }
  std::span<RowCrossing> all() { return sorted_; }
  std::span<RowCrossing> operator[](size_t n) {
    return all().subspan(begin_[n], begin_[n + 1] - begin_[n]);
  }

 private:
  std::vector<size_t> begin_;
  std::vector<RowCrossing> sorted_;
};

// An inside span of one row of a tube.
struct InsideSpan {
  LatticeRow row;
  CellSpan cells;
};

// Cuts the rows of one tube into segments and asks the rule about each.
std::vector<InsideSpan> InsideSpans(std::span<const RowCrossing> tube, const SegmentRule& rule) {
  std::vector<InsideSpan> spans;
  std::vector<CellSpan> inside;
  int winding = 0, crossings = 0;
  for (size_t n = 0; n + 1 < tube.size(); ++n) {
    winding += tube[n].winding;
    crossings += tube[n].crossings;
    if (tube[n].row != tube[n + 1].row) {
      winding = crossings = 0;
      continue;
    }
    if (tube[n].cell == tube[n + 1].cell) continue;
    const LatticeRow row = tube[n].row.row();
    inside.clear();
    rule.Append(row, {tube[n].cell, tube[n + 1].cell}, winding, crossings, inside);
    for (CellSpan cells : inside) spans.push_back({row, cells});
  }
  return spans;
}

// The ranges of bx that the spans touch, merged and in order.
std::vector<CellSpan> TouchedBricks(std::span<const InsideSpan> spans) {
  std::vector<CellSpan> touched;
  for (const InsideSpan& span : spans) {
    touched.push_back({span.cells.begin / kBrickX, (span.cells.end - 1) / kBrickX + 1});
  }
  std::ranges::sort(touched, {}, &CellSpan::begin);
  size_t kept = 0;
  for (const CellSpan& range : touched) {
    if (kept > 0 && range.begin <= touched[kept - 1].end) {
      touched[kept - 1].end = std::max(touched[kept - 1].end, range.end);
    } else {
      touched[kept++] = range;
    }
  }
  touched.resize(kept);
  return touched;
}

uint64_t LanesOf(CellSpan cells, int32_t bx) {
  const int32_t begin = std::max(cells.begin - bx * kBrickX, 0);
  const int32_t end = std::min(cells.end - bx * kBrickX, kBrickX);
  return ((uint64_t{1} << end) - 1) & ~((uint64_t{1} << begin) - 1);
}

// Writes the spans of one tube. Even and odd bricks are made in pairs, so that the place of a brick
// follows from its bx; a pair's empty half is dropped when the volume is made.
void WriteTube(std::span<const InsideSpan> spans, BrickList& list) {
  const int32_t by = spans[0].row.j / kBrickY, bz = spans[0].row.k / kBrickZ;
  const std::vector<CellSpan> touched = TouchedBricks(spans);
  std::vector<size_t> first;  // where the range's first pair stands, less 2 * its bx
  for (const CellSpan& range : touched) {
    first.push_back(list.keys.size());
    for (int32_t bx = range.begin; bx < range.end; ++bx) {
      for (Sublattice s : kSublattices) list.keys.emplace_back(BrickCoordinates{bx, by, bz, s});
    }
  }
  list.bricks.resize(list.keys.size());
  for (const auto& [row, cells] : spans) {
    const int32_t bx0 = cells.begin / kBrickX;
    const auto range = std::ranges::upper_bound(touched, bx0, {}, &CellSpan::begin) - 1;
    size_t at = first[static_cast<size_t>(range - touched.begin())] +
                2 * static_cast<size_t>(bx0 - range->begin) + static_cast<size_t>(row.sublattice);
    for (int32_t bx = bx0; bx <= (cells.end - 1) / kBrickX; ++bx, at += 2) {
      list.bricks[at].words[static_cast<size_t>(row.k % kBrickZ)] |= LanesOf(cells, bx)
                                                                     << (16 * (row.j % kBrickY));
    }
  }
}

// Fills slabs one by one until none is left; several workers share one filler.
class SlabFiller {
 public:
  SlabFiller(const FillRequest& request, const SegmentRule& rule, const exec::Context& context)
      : request_(request), rule_(rule), context_(context), plan_(request), lists_(plan_.size()) {}

  void Work() {
    for (size_t n = next_++; n < plan_.size() && !MustStop(); n = next_++) FillSlab(n);
  }

  // Needs: every worker is back.
  absl::StatusOr<Volume> Finish() {
    BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    if (points_ > request_.max_points) {
      return absl::ResourceExhaustedError(absl::StrFormat(
          "the solid has more than the limit of %d lattice points", request_.max_points));
    }
    BrickList all;
    for (BrickList& list : lists_) {
      all.keys.insert(all.keys.end(), list.keys.begin(), list.keys.end());
      all.bricks.insert(all.bricks.end(), list.bricks.begin(), list.bricks.end());
      list = {};
    }
    return Volume::FromSortedBricks(request_.extent, request_.placement, std::move(all.keys),
                                    std::move(all.bricks));
  }

 private:
  bool MustStop() const { return points_ > request_.max_points || context_.ShouldStop(); }

  void FillSlab(size_t n) {
    std::vector<RowCrossing> crossings;
    const std::span<const uint32_t> triangles = plan_.triangles(n);
    for (size_t t = 0; t < triangles.size(); ++t) {
      if (t % kTrianglesBetweenStops == 0 && MustStop()) return;
      AppendCrossings(request_, triangles[t], plan_.slab(n), crossings);
    }
    for (const SegmentRule::Region& region : rule_.extra_regions()) {
      AppendMarks(region, plan_.slab(n), crossings);
    }
    FillTubes(crossings, plan_.slab(n), lists_[n]);
  }

  // Crossings of one row are few, so a comparison sort of all would take most of the time.
  void FillTubes(std::span<const RowCrossing> crossings, Slab slab, BrickList& list) {
    const int32_t in_layer = (request_.extent.ny + kBrickY - 1) / kBrickY;
    const auto tube_of = [&](RowKey row) {
      return static_cast<size_t>((row.bz() - slab.begin_bz) * in_layer + row.by());
    };
    Buckets tubes, rows;
    tubes.Sort(crossings, static_cast<size_t>((slab.end_bz - slab.begin_bz) * in_layer), tube_of);
    for (size_t tube = 0; tube < tubes.size(); ++tube) {
      if (tubes[tube].empty()) continue;
      if (MustStop()) return;
      rows.Sort(tubes[tube], RowKey::kRowsOfTube, [](RowKey row) { return row.in_tube(); });
      for (size_t n = 0; n < rows.size(); ++n) std::ranges::sort(rows[n], {}, &RowCrossing::cell);
      const std::vector<InsideSpan> spans = InsideSpans(rows.all(), rule_);
      if (spans.empty() || !CountPoints(spans)) continue;
      WriteTube(spans, list);
    }
  }

  // False once the limit is passed, so that no memory is spent on what will be refused.
  bool CountPoints(std::span<const InsideSpan> spans) {
    uint64_t points = 0;
    for (const auto& [row, cells] : spans) points += static_cast<uint64_t>(cells.end - cells.begin);
    return (points_ += points) <= request_.max_points;
  }

  const FillRequest& request_;
  const SegmentRule& rule_;
  const exec::Context& context_;
  const SlabPlan plan_;
  std::vector<BrickList> lists_;
  std::atomic<size_t> next_{0};
  std::atomic<uint64_t> points_{0};
};

}  // namespace

absl::StatusOr<Volume> FillRows(const FillRequest& request, const SegmentRule& rule,
                                const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckCrossingWork(request, CrossingsOf(rule.extra_regions())));
  SlabFiller filler(request, rule, context);
  context.Offer([&filler](int) { filler.Work(); });
  return filler.Finish();
}

}  // namespace bccskel
