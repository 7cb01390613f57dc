#include "core/mask/mask_converter.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {

absl::StatusOr<MaskConverter> MaskConverter::Create(const MaskGrid& grid,
                                                    const MaskOptions& options) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskGrid(grid));
  MaskConverter converter(grid, options);
  if (options.sampling) {
    BCCSKEL_ASSIGN_OR_RETURN(const MaskLattice lattice, LatticeFor(grid, *options.sampling));
    converter.sampler_.emplace(grid, options.sampling->weights, lattice, options.part);
  }
  return converter;
}

MaskConverter::MaskConverter(const MaskGrid& grid, const MaskOptions& options)
    : grid_(grid),
      options_(options),
      parts_(options.sampling ? VoxelParts{1, 1, 1} : PartsOf(grid, options.points)),
      topology_(grid, options.adjacency),
      bricks_(options.adjacency, options.part) {}

absl::Status MaskConverter::AddSlice(std::span<const uint64_t> words,
                                     const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskSlice(grid_, next_z_, words));
  rows_.SetDense(grid_, words);
  return AddRows(next_z_++, rows_, context);
}

absl::Status MaskConverter::AddRows(int32_t z, SliceRows& rows, const exec::Context& context) {
  topology_.AddSlice(z, rows);
  if (sampler_) sampler_->AddSlice(z, rows);
  CutTubes(z, rows);
  BCCSKEL_RETURN_IF_ERROR(CheckBricks());
  return context.StopStatus();
}

void MaskConverter::CutTubes(int32_t z, SliceRows& rows) {
  const auto add = [this](const RowTube& tube) { AddTube(tube); };
  const auto [px, py, pz] = parts_;
  if (parts_ == VoxelParts{1, 1, 1}) return tubes_.AddSlice(z, rows, add);
  for (int32_t part = pz * z; part < pz * (z + 1); ++part) {
    refined_.SetParts(rows, px, py);
    tubes_.AddSlice(part, refined_, add);
  }
}

void MaskConverter::AddTube(const RowTube& tube) {
  topology_.AddTube(tube);
  if (!sampler_) bricks_.Add(tube);
}

absl::Status MaskConverter::CheckBricks() const {
  const uint64_t bricks = sampler_ ? sampler_->brick_count() : bricks_.brick_count();
  if (bricks <= options_.max_bricks) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrFormat(
      "the mask has more bricks of 512 points than the limit of %d", options_.max_bricks));
}

absl::StatusOr<ConvertedMask> MaskConverter::Finish() && {
  if (next_z_ != grid_.nz) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the mask ends after %d of %d slices", next_z_, grid_.nz));
  }
  return std::move(*this).FinishRows();
}

absl::StatusOr<ConvertedMask> MaskConverter::FinishRows() && {
  tubes_.Finish([this](const RowTube& tube) { AddTube(tube); });
  BCCSKEL_RETURN_IF_ERROR(CheckBricks());
  ConvertedMask converted;
  converted.voxels = topology_.voxels();
  converted.mask = std::move(topology_).Finish();
  if (sampler_) {
    BCCSKEL_ASSIGN_OR_RETURN(converted.volume, std::move(*sampler_).Finish());
  } else {
    converted.volume = std::move(bricks_).Finish(ExactExtent(grid_, options_.points),
                                                 ExactPlacement(grid_, options_.points));
  }
  return converted;
}

}  // namespace bccskel
