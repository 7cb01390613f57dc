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

// What is done to an object before it is thinned, in this order. Each step may change its topology.
struct PreparingOptions {
  // How often every point is set to the majority of itself and its 14 neighbors, up to
  // kMaxDenoisePasses. Destroys what is one or two lattice units thick.
  int32_t denoise_passes = 0;
  // Makes object of all background that does not reach the outside.
  CavityFilling cavities = CavityFilling::kOff;
  // Components of fewer points are dropped.
  uint64_t min_component_points = 0;
  // The same by volume, in cubic world units; 0 drops none.
  double min_component_volume = 0;
  // Of two largest components the one stays that has the first point in brick order.
  KeptComponents components = KeptComponents::kAll;
  // Fills tunnels that are narrower, in world units, up to 256 half edges of the cubic cell; 0
  // fills none. Components and cavities stay as they are, so a tunnel in which another component
  // lies stays, too.
  double tunnel_width = 0;
  // The same in shortest edges of a voxel, or of the cubic cell where the object has no voxels; see
  // TunnelWidthOf() for those that are longer one way.
  double tunnel_cells = 0;

  // A larger object is not made: cavities may hold far more bricks than the object.
  uint64_t max_bricks = std::numeric_limits<uint32_t>::max() - 1;

  // Whether anything is to be done.
  bool Wanted() const {
    return denoise_passes > 0 || cavities == CavityFilling::kOn || tunnel_width > 0 ||
           tunnel_cells > 0 || min_component_points > 0 || min_component_volume > 0 ||
           components == KeptComponents::kLargest;
  }
  friend bool operator==(const PreparingOptions&, const PreparingOptions&) = default;
};
inline constexpr int32_t kMaxDenoisePasses = 16;

// The width of tunnels in lattice units that PreparingOptions::tunnel_cells stands for, where a
// voxel is one cell: noise leaves gaps as high as the longest edge of a cell, so at least a quarter
// more than that. Fewer cells than this count as longest edges.
double TunnelWidthOf(double cells, const Placement& placement);

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckPreparingOptions(const PreparingOptions& options);

enum class PreparingStepKind : uint8_t {
  kDenoise,
  kFillCavities,
  kDropSmallComponents,
  kKeepLargestComponent,
  kFillTunnels,
};

// What a step did.
struct PreparingStep {
  PreparingStepKind kind = PreparingStepKind::kDenoise;
  // Passes that changed something, cavities or tunnels filled, or components dropped.
  uint64_t count = 0;
  uint64_t points_added = 0;
  uint64_t points_removed = 0;

  friend bool operator==(const PreparingStep&, const PreparingStep&) = default;
};

struct PreparedObject {
  Volume object;
  BettiNumbers before;               // of the object as given
  std::vector<PreparingStep> steps;  // those that were wanted, in their order
};

// The memory for filling tunnels is taken from the budget.
// `cells_per_voxel`: how many edges of the cubic cell make a voxel's edge, for tunnel_cells.
// Errors: INVALID_ARGUMENT (options), RESOURCE_EXHAUSTED (more than max_bricks), those of the
//         budget, CANCELLED, DEADLINE_EXCEEDED.
// Threads: uses all of the context's; the result is the same for any number.
absl::StatusOr<PreparedObject> Prepare(const Volume& object, const PreparingOptions& options,
                                       exec::MemoryBudget& memory, const exec::Context& context,
                                       int32_t cells_per_voxel = 1);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_PREPARE_H_
