#include "core/shells/shells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// Of a brick's points.
struct DistanceExtremes {
  uint32_t smallest;
  uint32_t largest;
};

ShellRule RuleFor(const ChamferWeights& weights, double shell_width) {
  return ShellRule(
      static_cast<uint64_t>(std::llround(weights.counts_per_unit * shell_width * 128)));
}

// For objects deeper than 16 bits and for the rare width whose borders single precision misses.
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

// Slices bricks of chamfer distances by the fastest exact way.
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

// Slices a field, one brick after the other.
class FieldSlicer {
 public:
  FieldSlicer(const Volume& object, const DistanceField& distance, double width)
      : object_(object), distance_(distance), euclidean_(width) {
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
    const SquaredRange range = SliceBrick(euclidean_, squares, planes);
    return {euclidean_(range.smallest), euclidean_(range.largest)};
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
  const EuclideanShellRule euclidean_;
  std::optional<ChamferSlicer> chamfer_;
};

using PlanesOfBricks = exec::UninitializedVector<ShellPlanes>;

PlanesOfBricks PlanesFor(const Volume& object) {
  PlanesOfBricks planes(object.brick_count() + 1);
  planes.back() = {};
  return planes;
}

// Slices distances while they are at hand.
class StreamSlicer : public DistanceSink {
 public:
  explicit StreamSlicer(const Volume& object) : object_(object) {}

  void Add(double width, ShellPlaces places) { cuts_.push_back({width, std::move(places), {}}); }

  void Begin(const ChamferWeights& weights, uint32_t limit) override {
    for (Cut& cut : cuts_) cut.slice.emplace(weights, cut.width, limit - 1);
  }
  uint32_t Take(BrickIndex brick, const uint16_t* distances) override {
    return Slice(brick, distances);
  }
  uint32_t Take(BrickIndex brick, const uint32_t* distances) override {
    return Slice(brick, distances);
  }

 private:
  struct Cut {
    double width;
    ShellPlaces places;
    std::optional<ChamferSlicer> slice;
  };

  template <typename T>
  uint32_t Slice(BrickIndex brick, const T* distances) {
    uint32_t largest = 0;
    for (const Cut& cut : cuts_) {
      const ShellPlace place = cut.places(brick);
      const DistanceExtremes found =
          (*cut.slice)(object_.bricks()[brick], distances, *place.planes);
      *place.range = cut.slice->ShellsOf(found);
      largest = found.largest;
    }
    return largest;
  }

  const Volume& object_;
  std::vector<Cut> cuts_;
};

constexpr size_t kSliceWork = 16;  // in the unit of Context::WorkersFor()

Shells SliceAll(const Volume& object, const DistanceField& distance, double width,
                const exec::Context& context) {
  const FieldSlicer slice(object, distance, width);
  PlanesOfBricks planes = PlanesFor(object);
  std::vector<Shells::Range> ranges(object.brick_count());
  exec::Portions portions(object.brick_count(), 64);
  context.Offer(context.WorkersFor(object.brick_count(), kSliceWork), [&](int) {
    for (exec::Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
      context.Rest();
      for (size_t n = mine.begin; n < mine.end; ++n) ranges[n] = slice(n, planes[n]);
    }
  });
  return Shells(std::move(planes), std::move(ranges));
}

}  // namespace

Shells::Shells(exec::UninitializedVector<ShellPlanes> planes, std::vector<Range> ranges)
    : planes_(std::move(planes)), ranges_(std::move(ranges)) {
  for (const Range& range : ranges_) last_ = std::max(last_, range.last);
}

int32_t ShellOf(uint32_t distance, const ChamferWeights& weights, double shell_width) {
  return RuleFor(weights, shell_width)(distance);
}

// Distances of two points of a brick differ by no more than the distance between them, which for
// chamfer distances is a bit longer than the straight one.
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
  return SliceAll(object, distance, width, context);
}

absl::StatusOr<Shells> StreamShells(const Volume& object, DistanceKind kind, double shell_width,
                                    const exec::Context& context, size_t at_once) {
  PlanesOfBricks planes = PlanesFor(object);
  std::vector<Shells::Range> ranges(object.brick_count());
  StreamSlicer slicer(object);
  slicer.Add(EffectiveShellWidth(shell_width, AxisScaleOf(object.placement())), [&](BrickIndex n) {
    return ShellPlace{&planes[n], &ranges[n]};
  });
  BCCSKEL_RETURN_IF_ERROR(StreamChamfer(object, kind, context, slicer, at_once));
  return Shells(std::move(planes), std::move(ranges));
}

absl::Status StreamShellsOfLayers(const Volume& object, const HeldLayers& held, DistanceKind kind,
                                  double shell_width, const exec::Context& context,
                                  LayerRelay& relay, const ShellPlaces& shells,
                                  const ShellPlaces& depths) {
  const AxisScale scale = AxisScaleOf(object.placement());
  StreamSlicer slicer(object);
  slicer.Add(EffectiveShellWidth(shell_width, scale), shells);
  if (depths) slicer.Add(DepthWidth(scale), depths);
  return StreamChamferOfLayers(object, held, kind, context, slicer, relay);
}

Shells BuildDepths(const Volume& object, const DistanceField& distance,
                   const exec::Context& context) {
  return SliceAll(object, distance, DepthWidth(AxisScaleOf(object.placement())), context);
}

}  // namespace bccskel
