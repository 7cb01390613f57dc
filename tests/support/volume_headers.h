#ifndef BCCSKEL_TESTS_SUPPORT_VOLUME_HEADERS_H_
#define BCCSKEL_TESTS_SUPPORT_VOLUME_HEADERS_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_header.h"
#include "core/mask/mask_grid.h"

namespace bccskel::test {

// Headers of the encodings that have none in their bytes, as senders declare them.

inline absl::StatusOr<VolumeHeader> MakePlanesHeader(
    const LatticeExtent& extent, const Placement& placement, const VolumeLimits& limits,
    VolumeCompression compression = VolumeCompression::kNone,
    std::optional<uint64_t> declared_bricks = std::nullopt) {
  return CompleteVolumeHeader({.encoding = VolumeEncoding::kRawPlanes,
                               .compression = compression,
                               .extent = extent,
                               .placement = placement,
                               .declared_bricks = declared_bricks},
                              limits);
}

inline absl::StatusOr<VolumeHeader> MakeMaskHeader(
    const MaskDeclaration& mask, const VolumeLimits& limits,
    VolumeCompression compression = VolumeCompression::kNone,
    std::optional<uint64_t> declared_bricks = std::nullopt) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskGrid(mask.grid));
  return CompleteVolumeHeader({.encoding = VolumeEncoding::kCubicMask,
                               .compression = compression,
                               .extent = ExactExtent(mask.grid, mask.points),
                               .placement = ExactPlacement(mask.grid, mask.points),
                               .mask = mask,
                               .declared_bricks = declared_bricks},
                              limits);
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_VOLUME_HEADERS_H_
