#include "core/import/shapes/shapes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/boundary_noise.h"
#include "core/import/shapes/figures.h"
#include "core/import/shapes/rasterize.h"

namespace bccskel {
namespace {

constexpr std::array<std::string_view, kShapes.size()> kNames = {
    "ball", "torus", "tubes", "blob", "horse", "tree", "knot", "box", "hollow-ball"};

constexpr double kGoodEnough = 0.01;
constexpr double kTolerance = 0.03;
constexpr int kMaxScales = 12;

absl::Status CheckShapeOptions(const ShapeOptions& options) {
  if (options.points < kMinShapePoints || options.points > kMaxShapePoints) {
    return absl::InvalidArgumentError(absl::StrFormat("a shape of %d points: must be %d to %d",
                                                      options.points, kMinShapePoints,
                                                      kMaxShapePoints));
  }
  if (!(options.noise >= 0 && options.noise <= kMaxShapeNoise)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("noise %g: must be 0 to %g", options.noise, kMaxShapeNoise));
  }
  return absl::OkStatus();
}

// By Newton's steps: the library's cube root differs between machines in the last bit.
double CubeRoot(double v) {
  double root = std::max(v, 1.0);
  for (int n = 0; n < 200; ++n) root = (2 * root + v / (root * root)) / 3;
  return root;
}

// Whether a point flips depends on its neighbors, which may lie in the layers beside its own.
absl::StatusOr<Volume> GenerateAtScale(std::span<const shapes::Solid> figure, double scale,
                                       const ShapeOptions& options, const LayerPart& part) {
  if (options.noise == 0) {
    return shapes::RasterizeLayers(figure, scale, [&](int32_t bz) { return part.Has(bz); });
  }
  BCCSKEL_ASSIGN_OR_RETURN(Volume clean, shapes::RasterizeLayers(figure, scale, [&](int32_t bz) {
                             return part.IsNear(bz);
                           }));
  BCCSKEL_ASSIGN_OR_RETURN(Volume noisy,
                           shapes::WithBoundaryNoise(clean, options.noise, options.seed));
  return part.count == 1 ? std::move(noisy) : OnlyLayers(noisy, part);
}

// A lattice point stands for four cubic units. The solids' boxes hold more than the solids do, so
// the first try is smaller than wanted, and cheap.
double FirstScale(std::span<const shapes::Solid> figure, uint64_t points) {
  double volume = 0;
  for (const shapes::Solid& solid : figure) {
    const shapes::Bounds bounds = shapes::BoundsOf(solid);
    const shapes::Vector size = bounds.high - bounds.low;
    volume += size.x * size.y * size.z;
  }
  return CubeRoot(4 * static_cast<double>(points) / volume);
}

}  // namespace

std::string_view ShapeName(Shape shape) { return kNames[static_cast<size_t>(shape)]; }

absl::StatusOr<Shape> ParseShapeName(std::string_view name) {
  std::string all;
  for (Shape shape : kShapes) {
    if (ShapeName(shape) == name) return shape;
    all.append(all.empty() ? "" : ", ").append(ShapeName(shape));
  }
  return absl::InvalidArgumentError("no shape is named \"" + std::string(name.substr(0, 100)) +
                                    "\": must be one of " + all);
}

absl::StatusOr<Volume> GenerateShape(Shape shape, const ShapeOptions& options) {
  return shapes::GenerateFigure(shapes::FigureOf(shape, options.seed), options);
}

absl::StatusOr<Volume> GenerateShapePart(Shape shape, const ShapeOptions& options,
                                         const LayerPart& part, const SumOfParts& sum) {
  return shapes::GenerateFigurePart(shapes::FigureOf(shape, options.seed), options, part, sum);
}

absl::StatusOr<Volume> shapes::GenerateFigure(std::span<const Solid> figure,
                                              const ShapeOptions& options) {
  return GenerateFigurePart(figure, options, {}, [](uint64_t points) { return points; });
}

absl::StatusOr<Volume> shapes::GenerateFigurePart(std::span<const Solid> figure,
                                                  const ShapeOptions& options,
                                                  const LayerPart& part, const SumOfParts& sum) {
  BCCSKEL_RETURN_IF_ERROR(CheckShapeOptions(options));
  const double wanted = static_cast<double>(options.points);
  double scale = FirstScale(figure, options.points);
  double ratio = 0;
  for (int n = 0; n < kMaxScales; ++n) {
    BCCSKEL_ASSIGN_OR_RETURN(Volume volume, GenerateAtScale(figure, scale, options, part));
    ratio = static_cast<double>(sum(volume.PointCount())) / wanted;
    const double allowed = n < kMaxScales / 2 ? kGoodEnough : kTolerance;
    if (std::abs(ratio - 1) <= allowed) return volume;
    scale /= CubeRoot(ratio);
  }
  return absl::InternalError(
      absl::StrFormat("no scale has within %g %% of %d points: the last had %.0f", 100 * kTolerance,
                      options.points, ratio * wanted));
}

}  // namespace bccskel
