#ifndef BCCSKEL_CORE_IMPORT_SHAPES_FIGURES_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_FIGURES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/shapes/shapes.h"
#include "core/import/shapes/solids.h"
#include "core/volume/volume.h"

namespace bccskel::shapes {

// The solids whose union is the shape, in figure units.
std::vector<Solid> FigureOf(Shape shape, uint64_t seed);

// The union of the solids at the scale that gives it the wanted number of points.
// Errors: as GenerateShape().
absl::StatusOr<Volume> GenerateFigure(std::span<const Solid> figure, const ShapeOptions& options);
// As GenerateShapePart().
absl::StatusOr<Volume> GenerateFigurePart(std::span<const Solid> figure,
                                          const ShapeOptions& options, const LayerPart& part,
                                          const SumOfParts& sum);

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_FIGURES_H_
