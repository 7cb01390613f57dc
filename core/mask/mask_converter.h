#ifndef BCCSKEL_CORE_MASK_MASK_CONVERTER_H_
#define BCCSKEL_CORE_MASK_MASK_CONVERTER_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/certificate/describe_changes.h"
#include "core/exec/context.h"
#include "core/mask/mask_grid.h"
#include "core/mask/mask_sampler.h"
#include "core/mask/mask_topology.h"
#include "core/mask/row_tubes.h"
#include "core/mask/slice_rows.h"
#include "core/mask/tube_bricks.h"
#include "core/volume/layer_part.h"
#include "core/volume/volume.h"

namespace bccskel {

struct MaskOptions {
  MaskAdjacency adjacency = MaskAdjacency::k26;
  VoxelPoints points = VoxelPoints::kTwo;  // of the exact conversion
  // No value: the exact conversion, which keeps the topology of the mask.
  std::optional<MaskSamplingOptions> sampling = std::nullopt;
  uint64_t max_bricks = uint64_t{1} << 28;
  LayerPart part = {};  // the part of the object to create
};

struct ConvertedMask {
  Volume volume;      // the part of the object
  BettiNumbers mask;  // of the whole mask, on the cubic grid, by MaskOptions::adjacency
  uint64_t voxels = 0;
};

// Converts a cubic mask to a bcc object slice by slice and counts its topology. The exact
// conversion keeps components, loops and cavities. Whether a sampling did is seen by comparing
// ConvertedMask::mask with CountBettiNumbers(volume), which is Certificate::input of the skeleton.
// Memory: at most ten slices, and the object.
class MaskConverter {
 public:
  // Errors: INVALID_ARGUMENT (grid, options), with the value and the limit.
  static absl::StatusOr<MaskConverter> Create(const MaskGrid& grid, const MaskOptions& options);

  // The next slice, from z = 0 on. Shapes: see MaskGrid.
  // Errors: INVALID_ARGUMENT (number of words or slices, a set bit past the last voxel of a row),
  //         RESOURCE_EXHAUSTED (max_bricks), CANCELLED, DEADLINE_EXCEEDED.
  absl::Status AddSlice(std::span<const uint64_t> words, const exec::Context& context);

  // The same for rows that are collected already; moves them out of `rows`.
  // Needs: rows inside the grid; z increases from call to call; omitted slices are empty.
  absl::Status AddRows(int32_t z, SliceRows& rows, const exec::Context& context);

  // Errors: INVALID_ARGUMENT if slices are missing.
  absl::StatusOr<ConvertedMask> Finish() &&;
  // Finish() after AddRows(), which allows slices to be omitted.
  absl::StatusOr<ConvertedMask> FinishRows() &&;

 private:
  MaskConverter(const MaskGrid& grid, const MaskOptions& options);
  void CutTubes(int32_t z, SliceRows& rows);
  void AddTube(const RowTube& tube);
  absl::Status CheckBricks() const;

  MaskGrid grid_;
  MaskOptions options_;
  VoxelParts parts_;
  MaskTopology topology_;
  RowTubes tubes_;
  TubeBricks bricks_;
  std::optional<MaskSampler> sampler_;
  SliceRows rows_;
  SliceRows refined_;
  int32_t next_z_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_MASK_CONVERTER_H_
