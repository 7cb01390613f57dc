#ifndef BCCSKEL_CORE_THINNING_THINNING_H_
#define BCCSKEL_CORE_THINNING_THINNING_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/shells/shells.h"
#include "core/volume/volume.h"

namespace bccskel {

// What happens to an end point whose neighbor is not a curve point (Condition 6, section 4).
enum class StubblePolicy : uint8_t {
  // Remove it, but never so many at one neighbor that the neighbor becomes an end point: with n
  // object neighbors at the neighbor q, and rank r among q's end points in neighbor bit order,
  // remove iff n > 2 and r < n - 2.
  kKeepTwo,
  // Remove it iff n > 2, as the paper writes. Several stubble points at one q can be removed
  // together and leave q an end point.
  kLiteral,
  // Keep it: the widely ramified skeleton of Fig. 8.
  kNone,
};

enum class ThinnessCleanup : uint8_t { kOn, kOff };

// How points are chosen for removal.
enum class ThinningMethod : uint8_t {
  // The paper's: eight passes per shell, one along each direction of D8.
  kDirectional,
  // The same with the order of the directions reversed on every second cycle, so that no side
  // always comes first.
  kDirectionalAlternating,
  // One pass per shell for all sides at once, the paper's future work. Independent of an order of
  // directions, so curves lie closer to the center.
  kSymmetric,
};

constexpr Depths DepthsOf(ThinningMethod method) {
  return method == ThinningMethod::kSymmetric ? Depths::kWanted : Depths::kNone;
}

// What is kept besides the topology, which also defines when a result is thin. All but kCurve need
// kSymmetric.
enum class SkeletonKind : uint8_t {
  // End points (Condition 2). Thin: only end points are simple.
  kCurve,
  // End points, and points as soon as they separate the background around them (2-isthmuses). Thin:
  // only those are simple.
  kSurface,
  // Nothing: a ball becomes a point, a torus a ring. Thin: no point is simple.
  kKernel,
  // Points as soon as they separate the object around them (1-isthmuses), instead of end points.
  // Thin: only those are simple.
  kIsthmusCurve,
};

struct ThinningOptions {
  ThinningMethod method = ThinningMethod::kDirectional;
  SkeletonKind kind = SkeletonKind::kCurve;
  // Applies to end points; kinds that keep none have no stubble.
  StubblePolicy stubble = StubblePolicy::kKeepTwo;
  ThinnessCleanup cleanup = ThinnessCleanup::kOn;
  // Thickness of a shell in lattice units (a D6 step is 2), kMinShellWidth to kMaxShellWidth.
  double shell_width = 1;
  // Stop after this shell; 0 means thin to the end.
  int32_t last_shell = 0;
  // Points that are never removed. Points outside the object are ignored.
  std::vector<LatticePoint> keep = {};
};

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckThinningOptions(const ThinningOptions& options);

struct ThinningTimes {
  std::chrono::nanoseconds shells{0};
  std::chrono::nanoseconds passes{0};  // includes making the resulting volume
  std::chrono::nanoseconds cleanup{0};
};

// A point that is kept as an isthmus, and the pass in which it first was one, counted from 1 over
// all shells. Each shell takes one pass and the last one several, so the pass is roughly the depth
// to which the object around the point had been peeled. Early births belong to thin parts and to
// noise on the surface.
struct IsthmusBirth {
  LatticePoint point;
  int32_t pass = 0;

  friend bool operator==(const IsthmusBirth&, const IsthmusBirth&) = default;
};

struct ThinningResult {
  Volume thin;
  // Of kSurface and kIsthmusCurve, in lattice order.
  std::vector<IsthmusBirth> isthmuses;
  int32_t last_shell = 0;  // the deepest shell of the object
  uint64_t removed = 0;    // by passes, including stubble
  uint64_t removed_by_cleanup = 0;
  uint32_t passes = 0;
  ThinningTimes times;
};

// The births of the points of `thin`, in the order of Volume::ForEachPoint(); 0 for points that
// never were isthmuses.
std::vector<int32_t> BirthsOf(const ThinningResult& result);

// Receives the points that were removed while a shell was thinned: once for each shell, in order,
// even if there are none; and, as shell `last_shell + 1`, those removed after the shells. Called on
// worker 0 while the others wait, so it should return soon.
using OnShellPoints = std::function<void(int32_t shell, Volume points)>;

// Parallel thinning with shells (section 5), by the given method and to the given kind of skeleton.
// Cost:   with `on_points`, a copy of the object and a visit to all bricks after each shell.
// Errors: INVALID_ARGUMENT (options), CANCELLED, DEADLINE_EXCEEDED.
// Threads: uses all of the context's; the result is the same for any number.
absl::StatusOr<ThinningResult> ThinObject(const Volume& object, const DistanceField& distance,
                                          const ThinningOptions& options,
                                          const exec::Context& context,
                                          const OnShellPoints& on_points = nullptr);

// The same without distances: from shells of options.shell_width, and depths for the symmetric
// method.
absl::StatusOr<ThinningResult> ThinByShells(const Volume& object, const Shells& shells,
                                            const BrickDepths& depths,
                                            const ThinningOptions& options,
                                            const exec::Context& context,
                                            const OnShellPoints& on_points = nullptr);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_THINNING_H_
