#include "core/mask/mask_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

bool TestVoxel(const MaskRow& row, int32_t x) {
  const int32_t word = x >> 6;
  if (word < row.first_word || word >= row.end_word()) return false;
  return (row.words[static_cast<size_t>(word - row.first_word)] >> (x & 63) & 1) != 0;
}

}  // namespace

absl::StatusOr<MaskLattice> LatticeFor(const MaskGrid& grid, const MaskSamplingOptions& options) {
  if (!(options.points_per_voxel >= kMinPointsPerVoxel &&
        options.points_per_voxel <= kMaxPointsPerVoxel)) {
    return absl::InvalidArgumentError(absl::StrFormat("points_per_voxel is %g: must be %g to %g",
                                                      options.points_per_voxel, kMinPointsPerVoxel,
                                                      kMaxPointsPerVoxel));
  }
  // Of a cell, in voxels along each axis. A cell holds two points.
  const double edge = std::cbrt(2 / options.points_per_voxel);
  const std::array<int32_t, 3> voxels = {grid.nx, grid.ny, grid.nz};
  std::array<int32_t, 3> cells = {};
  MaskLattice lattice;
  lattice.placement = VoxelPlacement(grid);
  for (size_t axis = 0; axis < 3; ++axis) {
    const double wanted = std::min(std::ceil(voxels[axis] / edge), 2.0 * kMaxExtentCells);
    cells[axis] = std::max(static_cast<int32_t>(wanted), 1);
    lattice.step[axis] = edge / 2;
    // Equal margins before the first point and after the last.
    lattice.first[axis] = (voxels[axis] - 1 - lattice.step[axis] * (2 * cells[axis] - 1)) / 2;
  }
  lattice.placement.origin =
      lattice.placement.ToWorld(2 * lattice.first[0], 2 * lattice.first[1], 2 * lattice.first[2]);
  for (size_t axis = 0; axis < 3; ++axis) lattice.placement.spacing[axis] *= edge;
  lattice.extent = {cells[0], cells[1], cells[2]};
  BCCSKEL_RETURN_IF_ERROR(CheckGrid(lattice.extent, lattice.placement));
  return lattice;
}

MaskSampler::MaskSampler(const MaskGrid& grid, MaskWeights weights, const MaskLattice& lattice,
                         const LayerPart& part)
    : grid_(grid), weights_(weights), lattice_(lattice), part_(part) {
  for (int32_t p = 0; p < 2 * lattice.extent.nx; ++p) stops_x_.push_back(StopAt(0, p));
}

MaskSampler::Stop MaskSampler::StopAt(size_t axis, int32_t p) const {
  const double at = lattice_.first[axis] + lattice_.step[axis] * p;
  if (weights_ == MaskWeights::kNearest) return {static_cast<int32_t>(std::floor(at + 0.5)), 0};
  const double lower = std::floor(at);
  return {static_cast<int32_t>(lower), at - lower};
}

const SliceRows& MaskSampler::Slice(int32_t z) const {
  if (z == current_z_) return current_;
  return z == before_z_ ? before_ : empty_;
}

void MaskSampler::AddSlice(int32_t z, const SliceRows& rows) {
  AdvanceTo(z - 1);
  std::swap(before_, current_);
  before_z_ = current_z_;
  current_ = rows;
  current_z_ = z;
  AdvanceTo(z);
}

absl::StatusOr<Volume> MaskSampler::Finish() && {
  AdvanceTo(std::numeric_limits<int32_t>::max());
  return Volume::Create(lattice_.extent, lattice_.placement, std::move(keys_), std::move(bricks_));
}

void MaskSampler::AdvanceTo(int32_t z) {
  for (; next_layer_ < 2 * lattice_.extent.nz; ++next_layer_) {
    const Stop stop = StopAt(2, next_layer_);
    if (stop.lower + (stop.upper_weight > 0 ? 1 : 0) > z) return;
    if (next_layer_ % (2 * kBrickZ) == 0) places_.clear();  // all earlier bricks are complete
    if (part_.Has(next_layer_ / (2 * kBrickZ))) SampleLayer(next_layer_);
  }
}

// The first lattice coordinate of an axis at or after `voxel`.
int32_t MaskSampler::FirstPointFrom(size_t axis, double voxel) const {
  const double p = std::ceil((voxel - lattice_.first[axis]) / lattice_.step[axis]);
  return static_cast<int32_t>(std::max(p, 0.0));
}

void MaskSampler::SampleLayer(int32_t pz) {
  const Stop z = StopAt(2, pz);
  const SliceRows &lower = Slice(z.lower), &upper = Slice(z.lower + 1);
  if (lower.empty() && upper.empty()) return;
  int32_t first = grid_.ny, last = -1;
  for (const SliceRows* slice : {&lower, &upper}) {
    if (slice->empty()) continue;
    first = std::min(first, slice->y(0));
    last = std::max(last, slice->y(slice->size() - 1));
  }
  const int32_t parity = pz & 1;
  for (int32_t py = FirstPointFrom(1, first - 1); py < 2 * lattice_.extent.ny; ++py) {
    if ((py & 1) != parity) continue;
    const Stop y = StopAt(1, py);
    if (y.lower > last) return;
    SampleRow({parity, py, pz},
              {{{lower.Find(y.lower), (1 - z.upper_weight) * (1 - y.upper_weight)},
                {lower.Find(y.lower + 1), (1 - z.upper_weight) * y.upper_weight},
                {upper.Find(y.lower), z.upper_weight * (1 - y.upper_weight)},
                {upper.Find(y.lower + 1), z.upper_weight * y.upper_weight}}});
  }
}

void MaskSampler::SampleRow(LatticePoint first, const std::array<WeightedRow, 4>& rows) {
  any_.assign(grid_.WordsPerRow(), 0);
  bool occupied = false;
  for (const auto& [row, weight] : rows) {
    if (weight == 0) continue;
    for (size_t n = 0; n < row.words.size(); ++n) {
      any_[static_cast<size_t>(row.first_word) + n] |= row.words[n];
      occupied = true;
    }
  }
  if (!occupied) return;
  ForEachRun({0, 0, any_}, [&](int32_t begin, int32_t end) {
    Profile(rows, begin - 1, end + 1);
    SampleRun(first, begin, end);
  });
}

// The weighted sum of the rows' voxels [begin, end).
void MaskSampler::Profile(const std::array<WeightedRow, 4>& rows, int32_t begin, int32_t end) {
  profile_begin_ = begin;
  profile_.assign(static_cast<size_t>(end - begin), 0);
  for (const auto& [row, weight] : rows) {
    if (weight == 0 || row.words.empty()) continue;
    for (int32_t x = std::max(begin, 0); x < std::min(end, grid_.nx); ++x) {
      if (TestVoxel(row, x)) profile_[static_cast<size_t>(x - begin)] += weight;
    }
  }
}

// The points whose voxels reach into the run [begin, end); the voxels beside it are empty.
void MaskSampler::SampleRun(LatticePoint row, int32_t begin, int32_t end) {
  const auto parity_up = [&](int32_t p) { return p + ((p ^ row.x) & 1); };
  int32_t p = parity_up(FirstPointFrom(0, begin - 1));
  for (; p < 2 * lattice_.extent.nx; p += 2) {
    const Stop x = stops_x_[static_cast<size_t>(p)];
    if (x.lower >= end) break;
    if (x.lower < begin - 1) continue;
    const double* at = profile_.data() + (x.lower - profile_begin_);
    if ((1 - x.upper_weight) * at[0] + x.upper_weight * at[1] >= 0.5) {
      AddPoint({p, row.y, row.z});
    }
  }
}

void MaskSampler::AddPoint(LatticePoint p) {
  const BrickAddress address = AddressOf(p);
  const BrickKey key(address.brick);
  if (keys_.empty() || key != last_key_) {
    const auto [at, fresh] = places_.try_emplace(key.value(), keys_.size());
    if (fresh) {
      keys_.push_back(key);
      bricks_.emplace_back();
    }
    last_key_ = key;
    last_place_ = at->second;
  }
  bricks_[last_place_].Set(address.bit);
}

}  // namespace bccskel
