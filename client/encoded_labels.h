#ifndef BCCSKEL_CLIENT_ENCODED_LABELS_H_
#define BCCSKEL_CLIENT_ENCODED_LABELS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_grid.h"

namespace bccskel::client {

// A segmented image: a label for each voxel, x fastest, z slowest, 0 for the background.
struct LabelVolume {
  MaskGrid grid;
  int label_bytes = 1;                // 1, 2, 4 or 8; little-endian, unsigned
  std::span<const std::byte> voxels;  // not owned
};

// A volume of labels ready to be sent, and its declaration.
struct EncodedLabels {
  MaskGrid grid;
  int label_bytes = 1;
  std::string bytes = {};  // zstd
  uint64_t voxels = 0;
  uint64_t largest_voxels = 0;
  uint64_t runs = 0;
  uint64_t labels = 0;
};

// A dense image of labels with the fewest bytes per voxel.
struct DenseLabels {
  int label_bytes = 1;
  std::vector<std::byte> voxels = {};
};
DenseLabels DenseLabelsOf(const LabeledObjects& labels);

// Counts only the labels in `wanted`; empty means all.
// Cost: one comparison per voxel, and compression.
// Errors: INVALID_ARGUMENT (grid, size of a label, number of bytes), CANCELLED.
absl::StatusOr<EncodedLabels> EncodeForSending(const LabelVolume& volume,
                                               const std::vector<uint64_t>& wanted,
                                               const std::stop_token& stop);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_ENCODED_LABELS_H_
