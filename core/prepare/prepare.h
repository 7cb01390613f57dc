#ifndef BCCSKEL_CORE_PREPARE_PREPARE_H_
#define BCCSKEL_CORE_PREPARE_PREPARE_H_

#include <cstdint>
#include <limits>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/volume/volume.h"

namespace bccskel {

enum class CavityFilling : uint8_t { kOff, kOn };
enum class KeptComponents : uint8_t { kAll, kLargest };

// What a number of points stands for.
enum class ComponentSize : uint8_t {
  kPoints,  // for itself
  // For as many voxels as make a block of that many points at two points per voxel:
  // PreparingForMask() (core/labels) replaces it. Objects without voxels have such points.
  kVoxels,
};

// The steps that prepare an object for thinning, in this order. Each may change its topology.
struct PreparingOptions {
  // How often every point is set to the majority of itself and its 14 neighbors, up to
  // kMaxDenoisePasses. Destroys parts that are one or two lattice units thick.
  int32_t denoise_passes = 0;
  // Turns all background that does not reach the outside into object.
  CavityFilling cavities = CavityFilling::kOff;
  // Joins components whose nearest points are at most this far apart, in world units, up to 256
  // half edges of the cubic cell, by bridges one point thick; 0 joins none.
  double join_gaps = 0;
  // Drops components with fewer points.
  uint64_t min_component_points = 0;
  ComponentSize component_size = ComponentSize::kPoints;
  // The same by volume, in cubic world units; 0 drops none.
  double min_component_volume = 0;
  // Of several largest components, the one with the first point in brick order stays.
  KeptComponents components = KeptComponents::kAll;
  // Fills tunnels narrower than this, in world units, up to 256 half edges of the cubic cell; 0
  // fills none. Components and cavities stay, so a tunnel that contains another component stays,
  // too.
  double tunnel_width = 0;
  // The same in shortest edges of a voxel, or of the cubic cell where the object has no voxels; see
  // TunnelWidthOf() for elongated cells.
  double tunnel_cells = 0;

  // The limit of the prepared object: cavities may hold far more bricks than the object.
  uint64_t max_bricks = std::numeric_limits<uint32_t>::max() - 1;

  // Whether anything is to be done.
  bool Wanted() const {
    return denoise_passes > 0 || cavities == CavityFilling::kOn || join_gaps > 0 ||
           tunnel_width > 0 || tunnel_cells > 0 || min_component_points > 0 ||
           min_component_volume > 0 || components == KeptComponents::kLargest;
  }
  friend bool operator==(const PreparingOptions&, const PreparingOptions&) = default;
};
inline constexpr int32_t kMaxDenoisePasses = 16;
// In any unit more than can be filled.
inline constexpr double kMaxTunnelWidthToFill = 1e9;
inline constexpr double kMaxGapToJoin = 1e9;

// The width of tunnels in lattice units for PreparingOptions::tunnel_cells, where a voxel is one
// cell. Noise leaves gaps as high as the longest edge of a cell, so the width is at least 1.25
// longest edges, or `cells` longest edges if that is less.
double TunnelWidthOf(double cells, const Placement& placement);

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckPreparingOptions(const PreparingOptions& options);

enum class PreparingStepKind : uint8_t {
  kDenoise,
  kFillCavities,
  kDropSmallComponents,
  kKeepLargestComponent,
  kFillTunnels,
  kJoinGaps,
};

// What a step did.
struct PreparingStep {
  PreparingStepKind kind = PreparingStepKind::kDenoise;
  // Passes that changed something, cavities or tunnels filled, gaps joined, or components dropped.
  uint64_t count = 0;
  uint64_t points_added = 0;
  uint64_t points_removed = 0;

  friend bool operator==(const PreparingStep&, const PreparingStep&) = default;
};

struct PreparedObject {
  Volume object;
  BettiNumbers before;               // of the object as given
  std::vector<PreparingStep> steps;  // the requested steps, in order
};

// Runs the requested steps. Filling tunnels and joining gaps take memory from the budget.
// `cells_per_voxel`: how many edges of the cubic cell make an edge of a voxel, for tunnel_cells.
// Errors: INVALID_ARGUMENT (options), RESOURCE_EXHAUSTED (more than max_bricks), those of the
//         budget, CANCELLED, DEADLINE_EXCEEDED.
// Threads: uses all of the context's; the result is the same for any number.
absl::StatusOr<PreparedObject> Prepare(const Volume& object, const PreparingOptions& options,
                                       exec::MemoryBudget& memory, const exec::Context& context,
                                       int32_t cells_per_voxel = 1);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_PREPARE_H_
