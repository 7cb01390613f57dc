#ifndef BCCSKEL_CORE_SHELLS_SHELLS_H_
#define BCCSKEL_CORE_SHELLS_SHELLS_H_

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/distance/chamfer_scan.h"
#include "core/distance/distance_field.h"
#include "core/distance/euclidean_stream.h"
#include "core/exec/context.h"
#include "core/exec/uninitialized.h"
#include "core/shells/slice_bricks.h"
#include "core/volume/brick.h"
#include "core/volume/volume.h"

namespace bccskel {

// The shell of a distance: floor(distance / shell_width + 1/2), at least 1 (section 4, S_i, for
// object points). `distance` in counts of `weights`; `shell_width` in lattice units, rounded to
// 1/128 count so that the rule uses integers.
int32_t ShellOf(uint32_t distance, const ChamferWeights& weights, double shell_width);

// The actual thickness of shells: the wanted one, or more if the spacings differ so much that a
// brick could hold more than 63 shells of that thickness.
double EffectiveShellWidth(double wanted, const AxisScale& scale);

// The shells of an object's points, sliced into bit planes: plane b of a brick holds bit b of
// (shell modulo 64) for its 512 points, so that "shell equals c" is six logic operations for all of
// them. Modulo 64 is enough because EffectiveShellWidth() keeps a brick's shells apart.
class Shells {
 public:
  struct Range {
    int32_t first = 0;  // smallest and largest shell of the brick's points
    int32_t last = 0;
  };

  Shells() = default;
  // Shapes: planes for each brick and the padding brick.
  Shells(exec::UninitializedVector<ShellPlanes> planes, std::vector<Range> ranges);

  int32_t last() const { return last_; }
  // Sets the deepest shell of the whole object, if these shells are a part of it.
  void SetLast(int32_t last) { last_ = last; }
  const Range& RangeOf(BrickIndex brick) const { return ranges_[brick]; }
  size_t brick_count() const { return ranges_.size(); }

  // The planes of shell modulo 64, with a padding brick for bricks that are not stored. Bits of
  // background points are arbitrary.
  std::span<const ShellPlanes> planes() const { return planes_; }

 private:
  exec::UninitializedVector<ShellPlanes> planes_;
  std::vector<Range> ranges_;
  int32_t last_ = 0;
};

// `shell_width` is the wanted thickness in lattice units.
// Needs: kMinShellWidth <= shell_width <= kMaxShellWidth; `distance` belongs to `object`.
Shells BuildShells(const Volume& object, const DistanceField& distance, double shell_width,
                   const exec::Context& context);

// The same from chamfer distances that are not needed afterwards: measured and sliced in one pass,
// with less memory. `at_once` as for StreamChamfer().
// Needs:  not kEuclidean.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<Shells> StreamShells(const Volume& object, DistanceKind kind, double shell_width,
                                    const exec::Context& context,
                                    size_t at_once = kMostPointsAtOnce);

// Depths of points: thinner shells, modulo 32, which determine the deeper one of two neighbors,
// since those of neighbors differ by less than 16. Shapes: planes for each brick and the padding
// brick. Bits of background points are arbitrary.
using BrickDepths = exec::UninitializedVector<DepthPlanes>;

BrickDepths BuildDepths(const Volume& object, const DistanceField& distance,
                        const exec::Context& context);

// Where the shells and depths of a brick are written.
// Threads: called on several workers at once.
struct ShellPlace {
  ShellPlanes* planes;
  Shells::Range* range;
};
struct ShellPlaces {
  std::function<ShellPlace(BrickIndex)> shells;
  // As from BuildDepths(); null if not wanted.
  std::function<DepthPlanes&(BrickIndex)> depths = nullptr;
};

// StreamShells() for one holder's layers, as StreamChamferOfLayers().
absl::Status StreamShellsOfLayers(const Volume& object, const HeldLayers& held, DistanceKind kind,
                                  double shell_width, const exec::Context& context,
                                  LayerRelay& relay, const ShellPlaces& places);

// Slices squared distances and writes them to `places`.
class SquareSlicer : public SquareSink {
 public:
  // `shell_width` is the wanted thickness in lattice units; `scale` that of the object.
  SquareSlicer(const AxisScale& scale, double shell_width, ShellPlaces places);

  void Take(BrickIndex brick, const uint16_t* squares) override { Slice(brick, squares); }
  void Take(BrickIndex brick, const float* squares) override { Slice(brick, squares); }

 private:
  template <typename T>
  void Slice(BrickIndex brick, const T* squares);

  const SquareRules rules_;
  const ShellPlaces places_;
};

// The thickness of the shells of BuildDepths(): a quarter of a lattice unit, or more if the
// spacings differ so much that neighbors could be 16 quarters apart.
double DepthWidth(const AxisScale& scale);

// Whether the thinning method compares depths, as the symmetric one does.
enum class Depths : uint8_t { kNone, kWanted };

// Shells and, if wanted, depths from Euclidean distances, sliced while distances are measured.
struct EuclideanShells {
  Shells shells;
  BrickDepths depths;
  std::optional<DistanceField> distance;  // if KeepField::kIfSmall keeps it
};
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<EuclideanShells> StreamEuclideanShells(const Volume& object, double shell_width,
                                                      Depths depths, const exec::Context& context,
                                                      size_t at_once = kMostSquaresAtOnce);

inline constexpr double kMinShellWidth = 0.75;
inline constexpr double kMaxShellWidth = 64;

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SHELLS_SHELLS_H_
