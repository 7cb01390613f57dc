#ifndef BCCSKEL_CORE_LABELS_LABEL_COLLECTOR_H_
#define BCCSKEL_CORE_LABELS_LABEL_COLLECTOR_H_

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/slice_rows.h"

namespace bccskel {

struct LabelFilter {
  std::vector<uint64_t> labels = {};  // none: all but 0, the background
  uint64_t min_voxels = 1;            // smaller objects are left out
  uint64_t max_runs = uint64_t{1} << 28;
  uint64_t max_labels = uint64_t{1} << 28;  // where `labels` does not list them
};

// Gathers the voxels of every label in one pass over the slices of an image.
// Memory: 16 bytes for each run of voxels of a wanted label. Cost: one comparison a voxel, one
// look-up a run.
class LabelCollector {
 public:
  // Errors: INVALID_ARGUMENT (grid, background among the labels).
  static absl::StatusOr<LabelCollector> Create(const MaskGrid& grid, const LabelFilter& filter);

  // The next slice, from z = 0 on. Shapes: see MaskGrid.
  // Errors: INVALID_ARGUMENT (number of values or slices), RESOURCE_EXHAUSTED (max_runs or
  //         max_labels, checked after each row), CANCELLED, DEADLINE_EXCEEDED.
  absl::Status AddSlice(std::span<const uint64_t> labels, const exec::Context& context);
  // The same for a slice of a mask, whose voxels get label 1.
  absl::Status AddMaskSlice(std::span<const uint64_t> words, const exec::Context& context);

  // Errors: INVALID_ARGUMENT when slices are missing.
  absl::StatusOr<LabeledObjects> Finish() &&;

 private:
  LabelCollector(const MaskGrid& grid, const LabelFilter& filter);
  absl::Status CheckLimits() const;
  void AddRow(std::span<const uint64_t> labels, int32_t y);
  void AddRun(uint64_t label, const VoxelRun& run);
  LabeledObject* Find(uint64_t label);

  MaskGrid grid_;
  LabelFilter filter_;
  std::vector<LabeledObject> objects_;
  std::unordered_map<uint64_t, size_t> places_;
  uint64_t last_label_ = 0;
  LabeledObject* last_object_ = nullptr;  // null: not wanted
  uint64_t runs_ = 0;
  int32_t next_z_ = 0;
  SliceRows rows_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_LABEL_COLLECTOR_H_
