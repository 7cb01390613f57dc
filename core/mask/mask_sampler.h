#ifndef BCCSKEL_CORE_MASK_MASK_SAMPLER_H_
#define BCCSKEL_CORE_MASK_MASK_SAMPLER_H_

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/mask/mask_grid.h"
#include "core/mask/slice_rows.h"
#include "core/volume/layer_part.h"
#include "core/volume/volume.h"

namespace bccskel {

// Weights of the voxels around a point.
enum class MaskWeights : uint8_t {
  kNearest,    // the voxel that holds the point
  kTrilinear,  // linear between voxel centers along each axis; object from 1/2 on
};

inline constexpr double kMinPointsPerVoxel = 0.01;
inline constexpr double kMaxPointsPerVoxel = 1000;

struct MaskSamplingOptions {
  MaskWeights weights = MaskWeights::kTrilinear;
  double points_per_voxel = 2;  // kMinPointsPerVoxel to kMaxPointsPerVoxel
};

// The lattice that samples a mask: coordinate p of an axis lies at first + step * p, in voxels.
struct MaskLattice {
  LatticeExtent extent;
  Placement placement;
  std::array<double, 3> first = {};
  std::array<double, 3> step = {};
};

// Errors: INVALID_ARGUMENT (density, too many cells), with the value and the limit.
absl::StatusOr<MaskLattice> LatticeFor(const MaskGrid& grid, const MaskSamplingOptions& options);

// Samples a mask at the points of a lattice, slice by slice. The topology may change.
// Memory: the occupied rows of two slices. Cost: proportional to the runs and the points near them.
class MaskSampler {
 public:
  MaskSampler(const MaskGrid& grid, MaskWeights weights, const MaskLattice& lattice,
              const LayerPart& part = {});

  // Needs: z increases from call to call; omitted slices are empty.
  void AddSlice(int32_t z, const SliceRows& rows);
  size_t brick_count() const { return keys_.size(); }
  // Errors: as Volume::Create().
  absl::StatusOr<Volume> Finish() &&;

 private:
  // Voxel `lower` of an axis weighs 1 - upper_weight, the next one upper_weight.
  struct Stop {
    int32_t lower = 0;
    double upper_weight = 0;
  };
  struct WeightedRow {
    MaskRow row;
    double weight = 0;
  };

  Stop StopAt(size_t axis, int32_t p) const;
  const SliceRows& Slice(int32_t z) const;
  // Samples the layers that need no slice above `z`.
  void AdvanceTo(int32_t z);
  void SampleLayer(int32_t pz);
  void SampleRow(LatticePoint first, const std::array<WeightedRow, 4>& rows);
  void SampleRun(LatticePoint row, int32_t begin, int32_t end);
  void Profile(const std::array<WeightedRow, 4>& rows, int32_t begin, int32_t end);
  int32_t FirstPointFrom(size_t axis, double voxel) const;
  void AddPoint(LatticePoint p);

  const MaskGrid grid_;
  const MaskWeights weights_;
  const MaskLattice lattice_;
  const LayerPart part_;
  std::vector<BrickKey> keys_;
  std::vector<BrickBits> bricks_;
  std::unordered_map<uint64_t, size_t> places_;  // of the bricks of the layer
  BrickKey last_key_;                            // the brick at last_place_
  size_t last_place_ = 0;
  std::vector<Stop> stops_x_;
  SliceRows before_, current_;
  const SliceRows empty_;
  int32_t current_z_ = -1;
  int32_t before_z_ = -1;
  int32_t next_layer_ = 0;
  std::vector<uint64_t> any_;    // union of the mask rows for one lattice row
  std::vector<double> profile_;  // weighted voxels from profile_begin_ on
  int32_t profile_begin_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_MASK_SAMPLER_H_
