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
  // None: the exact conversion, which keeps the mask's topology.
  std::optional<MaskSamplingOptions> sampling = std::nullopt;
  uint64_t max_bricks = uint64_t{1} << 28;
  LayerPart part = {};  // of the object, that is made
};

// The edge of a voxel in lattice units, which is the height of the steps in the object's surface:
// 2 after the exact conversion, 4 with sixteen points a voxel.
double VoxelEdge(const MaskOptions& options);

struct ConvertedMask {
  Volume volume;      // the part of the object
  BettiNumbers mask;  // of all, counted on the cubic grid, in the reading of MaskOptions::adjacency
  uint64_t voxels = 0;
};

// Turns a cubic mask into a bcc object while its slices pass by, and counts its topology.
// The exact conversion keeps components, loops and cavities; whether a sampling did is seen by
// comparing ConvertedMask::mask with CountBettiNumbers(volume), which is Certificate::input of the
// skeleton.
// Memory: ten slices at most, and the object.
class MaskConverter {
 public:
  // Errors: INVALID_ARGUMENT (grid, options), with the value and the limit.
  static absl::StatusOr<MaskConverter> Create(const MaskGrid& grid, const MaskOptions& options);

  // The next slice, from z = 0 on. Shapes: see MaskGrid.
  // Errors: INVALID_ARGUMENT (number of words or slices, a set bit past the last voxel of a row),
  //         RESOURCE_EXHAUSTED (max_bricks), CANCELLED, DEADLINE_EXCEEDED.
  absl::Status AddSlice(std::span<const uint64_t> words, const exec::Context& context);

  // The same for rows that are gathered already, taken out of `rows`.
  // Needs: rows inside the grid, z grows from call to call; slices left out are empty.
  absl::Status AddRows(int32_t z, SliceRows& rows, const exec::Context& context);

  // Errors: INVALID_ARGUMENT when slices are missing.
  absl::StatusOr<ConvertedMask> Finish() &&;
  // After AddRows(), where slices may be left out.
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
