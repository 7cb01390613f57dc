#include "core/shells/shells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// The extremes of a brick's points.
struct DistanceExtremes {
  uint32_t smallest;
  uint32_t largest;
};

ShellRule RuleFor(const ChamferWeights& weights, double shell_width) {
  return ShellRule(
      static_cast<uint64_t>(std::llround(weights.counts_per_unit * shell_width * 128)));
}

// Slices point by point, for objects deeper than 16 bits and for the rare width whose borders
// single precision misses.
template <typename T>
DistanceExtremes SliceExactly(const ShellRule& rule, const BrickBits& object, const T* distances,
                              ShellPlanes& planes) {
  DistanceExtremes found = {UINT32_MAX, 0};
  planes = {};
  object.ForEachSetBit([&](int bit) {
    const uint32_t distance = distances[bit];
    found = {std::min(found.smallest, distance), std::max(found.largest, distance)};
    const int32_t shell = rule(distance);
    for (int b = 0; b < kShellPlanes; ++b) {
      if ((shell >> b & 1) != 0) planes[static_cast<size_t>(b)].Set(bit);
    }
  });
  return found;
}

// Slices bricks of chamfer distances in the fastest exact way.
class ChamferSlicer {
 public:
  // Needs: no distance is above `largest`.
  ChamferSlicer(const ChamferWeights& weights, double width, uint32_t largest)
      : rule_(RuleFor(weights, width)), fast_(MakeFloatRule(rule_, largest)) {}

  DistanceExtremes operator()(const BrickBits& object, const uint16_t* distances,
                              ShellPlanes& planes) const {
    if (!fast_.exact) return SliceExactly(rule_, object, distances, planes);
    const DistanceRange range = SliceBrick(fast_.rule, distances, planes);
    return {range.smallest, range.largest};
  }
  DistanceExtremes operator()(const BrickBits& object, const uint32_t* distances,
                              ShellPlanes& planes) const {
    return SliceExactly(rule_, object, distances, planes);
  }
  Shells::Range ShellsOf(const DistanceExtremes& range) const {
    return {rule_(range.smallest), rule_(range.largest)};
  }

 private:
  const ShellRule rule_;
  const CheckedFloatRule fast_;
};

// Slices a distance field brick by brick.
class FieldSlicer {
 public:
  FieldSlicer(const Volume& object, const DistanceField& distance, double width)
      : object_(object), distance_(distance), euclidean_{width, width} {
    if (distance.kind() == DistanceKind::kEuclidean) return;
    chamfer_.emplace(distance.weights(), width, distance.largest());
  }

  Shells::Range operator()(size_t brick, ShellPlanes& planes) const {
    return std::visit(
        [&](const auto& values) {
          return Slice(object_.bricks()[brick], values.data() + brick * kBrickPoints, planes);
        },
        distance_.values());
  }

 private:
  template <typename T>
  Shells::Range SliceSquares(const T* squares, ShellPlanes& planes) const {
    const SquaredRange range = SliceBrick(euclidean_, squares, planes, nullptr);
    return {euclidean_.shell(range.smallest), euclidean_.shell(range.largest)};
  }
  Shells::Range Slice(const BrickBits&, const float* squares, ShellPlanes& planes) const {
    return SliceSquares(squares, planes);
  }
  Shells::Range Slice(const BrickBits& object, const uint16_t* distances,
                      ShellPlanes& planes) const {
    if (!chamfer_.has_value()) return SliceSquares(distances, planes);
    return chamfer_->ShellsOf((*chamfer_)(object, distances, planes));
  }
  Shells::Range Slice(const BrickBits& object, const uint32_t* distances,
                      ShellPlanes& planes) const {
    return chamfer_->ShellsOf((*chamfer_)(object, distances, planes));
  }

  const Volume& object_;
  const DistanceField& distance_;
  const SquareRules euclidean_;
  std::optional<ChamferSlicer> chamfer_;
};

using PlanesOfBricks = exec::UninitializedVector<ShellPlanes>;

PlanesOfBricks PlanesFor(const Volume& object) {
  PlanesOfBricks planes(object.brick_count() + 1);
  planes.back() = {};
  return planes;
}

BrickDepths DepthsFor(const Volume& object) {
  BrickDepths depths(object.brick_count() + 1);
  depths.back() = {};
  return depths;
}

void KeepDepths(const ShellPlanes& planes, DepthPlanes& depths) {
  std::copy_n(planes.begin(), kDepthPlanes, depths.begin());
}

// Slices chamfer distances as they are streamed.
class StreamSlicer : public DistanceSink {
 public:
  // Needs: `object` outlives this.
  StreamSlicer(const Volume& object, double width, ShellPlaces places)
      : object_(object), width_(width), places_(std::move(places)) {}

  void Begin(const ChamferWeights& weights, uint32_t limit) override {
    shell_.emplace(weights, width_, limit - 1);
    if (places_.depths)
      depth_.emplace(weights, DepthWidth(AxisScaleOf(object_.placement())), limit - 1);
  }
  uint32_t Take(BrickIndex brick, const uint16_t* distances) override {
    return Slice(brick, distances);
  }
  uint32_t Take(BrickIndex brick, const uint32_t* distances) override {
    return Slice(brick, distances);
  }

 private:
  template <typename T>
  uint32_t Slice(BrickIndex brick, const T* distances) {
    const BrickBits& bits = object_.bricks()[brick];
    const ShellPlace place = places_.shells(brick);
    const DistanceExtremes found = (*shell_)(bits, distances, *place.planes);
    *place.range = shell_->ShellsOf(found);
    if (places_.depths) {
      ShellPlanes planes;
      (*depth_)(bits, distances, planes);
      KeepDepths(planes, places_.depths(brick));
    }
    return found.largest;
  }

  const Volume& object_;
  const double width_;
  const ShellPlaces places_;
  std::optional<ChamferSlicer> shell_;
  std::optional<ChamferSlicer> depth_;
};

constexpr size_t kSliceWork = 16;  // in the unit of Context::WorkersFor()

template <typename Slice>
void SliceAll(const Volume& object, const exec::Context& context, Slice slice) {
  exec::Portions portions(object.brick_count(), 64);
  context.Offer(context.WorkersFor(object.brick_count(), kSliceWork), [&](int) {
    for (exec::Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
      context.Yield();
      for (size_t n = mine.begin; n < mine.end; ++n) slice(n);
    }
  });
}

}  // namespace

Shells::Shells(exec::UninitializedVector<ShellPlanes> planes, std::vector<Range> ranges)
    : planes_(std::move(planes)), ranges_(std::move(ranges)) {
  for (const Range& range : ranges_) last_ = std::max(last_, range.last);
}

int32_t ShellOf(uint32_t distance, const ChamferWeights& weights, double shell_width) {
  return RuleFor(weights, shell_width)(distance);
}

// The distances of two points of a brick differ by at most the distance between them; a chamfer
// distance is slightly longer than the straight one.
double EffectiveShellWidth(double wanted, const AxisScale& scale) {
  const double x = 2 * (kBrickX - 1) * scale[0], y = 2 * (kBrickY - 1) * scale[1],
               z = 2 * (kBrickZ - 1) * scale[2];
  const double across = LargestOverestimate(scale) * std::sqrt(x * x + y * y + z * z);
  return std::max(wanted, across / 62);
}

double DepthWidth(const AxisScale& scale) {
  const double longest_step = 2 * std::max({scale[0], scale[1], scale[2]});
  return std::max(0.25, LargestOverestimate(scale) * longest_step / 14);
}

Shells BuildShells(const Volume& object, const DistanceField& distance, double shell_width,
                   const exec::Context& context) {
  const double width = EffectiveShellWidth(shell_width, AxisScaleOf(object.placement()));
  const FieldSlicer slice(object, distance, width);
  PlanesOfBricks planes = PlanesFor(object);
  std::vector<Shells::Range> ranges(object.brick_count());
  SliceAll(object, context, [&](size_t n) { ranges[n] = slice(n, planes[n]); });
  return Shells(std::move(planes), std::move(ranges));
}

absl::StatusOr<Shells> StreamShells(const Volume& object, DistanceKind kind, double shell_width,
                                    const exec::Context& context, size_t at_once) {
  PlanesOfBricks planes = PlanesFor(object);
  std::vector<Shells::Range> ranges(object.brick_count());
  const double width = EffectiveShellWidth(shell_width, AxisScaleOf(object.placement()));
  const ShellPlaces places = {[&](BrickIndex n) { return ShellPlace{&planes[n], &ranges[n]}; }};
  StreamSlicer slicer(object, width, places);
  BCCSKEL_RETURN_IF_ERROR(StreamChamfer(object, kind, context, slicer, at_once));
  return Shells(std::move(planes), std::move(ranges));
}

absl::Status StreamShellsOfLayers(const Volume& object, const HeldLayers& held, DistanceKind kind,
                                  double shell_width, const exec::Context& context,
                                  LayerRelay& relay, const ShellPlaces& places) {
  const double width = EffectiveShellWidth(shell_width, AxisScaleOf(object.placement()));
  StreamSlicer slicer(object, width, places);
  return StreamChamferOfLayers(object, held, kind, context, slicer, relay);
}

BrickDepths BuildDepths(const Volume& object, const DistanceField& distance,
                        const exec::Context& context) {
  const FieldSlicer slice(object, distance, DepthWidth(AxisScaleOf(object.placement())));
  BrickDepths depths = DepthsFor(object);
  SliceAll(object, context, [&](size_t n) {
    ShellPlanes planes;
    slice(n, planes);
    KeepDepths(planes, depths[n]);
  });
  return depths;
}

SquareSlicer::SquareSlicer(const AxisScale& scale, double shell_width, ShellPlaces places)
    : rules_(EffectiveShellWidth(shell_width, scale), DepthWidth(scale)),
      places_(std::move(places)) {}

template <typename T>
void SquareSlicer::Slice(BrickIndex brick, const T* squares) {
  const ShellPlace place = places_.shells(brick);
  DepthPlanes* depths = places_.depths ? &places_.depths(brick) : nullptr;
  const SquaredRange range = SliceBrick(rules_, squares, *place.planes, depths);
  *place.range = {rules_.shell(range.smallest), rules_.shell(range.largest)};
}
template void SquareSlicer::Slice(BrickIndex, const uint16_t*);
template void SquareSlicer::Slice(BrickIndex, const float*);

absl::StatusOr<EuclideanShells> StreamEuclideanShells(const Volume& object, double shell_width,
                                                      Depths depths, const exec::Context& context,
                                                      size_t at_once) {
  PlanesOfBricks planes = PlanesFor(object);
  std::vector<Shells::Range> ranges(object.brick_count());
  ShellPlaces places = {[&](BrickIndex n) { return ShellPlace{&planes[n], &ranges[n]}; }};
  BrickDepths deep;
  if (depths == Depths::kWanted) {
    deep = DepthsFor(object);
    places.depths = [&](BrickIndex n) -> DepthPlanes& { return deep[n]; };
  }
  SquareSlicer slicer(AxisScaleOf(object.placement()), shell_width, std::move(places));
  EuclideanShells measured;
  BCCSKEL_ASSIGN_OR_RETURN(measured.distance,
                           StreamEuclidean(object, context, &slicer, KeepField::kIfSmall, at_once));
  measured.shells = Shells(std::move(planes), std::move(ranges));
  measured.depths = std::move(deep);
  return measured;
}

}  // namespace bccskel
