#ifndef BCCSKEL_CORE_IMPORT_SHAPES_RASTERIZE_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_RASTERIZE_H_

#include <functional>
#include <span>

#include "absl/status/statusor.h"
#include "core/import/shapes/solids.h"
#include "core/volume/volume.h"

namespace bccskel::shapes {

// The lattice points of the union of the solids, `scale` lattice units per figure unit. The
// volume's box has two free cells around the figure. Errors: INVALID_ARGUMENT when the box exceeds
// the largest extent.
// Cost:   per solid one square root or a few for each row of each brick column that it may touch,
//         and word operations for the bricks that it does touch.
absl::StatusOr<Volume> Rasterize(std::span<const Solid> solids, double scale);

// Tells layers of bricks.
using ChooseLayer = std::function<bool(int32_t bz)>;
// The same without the bricks of other layers. Cost: of the chosen layers only.
absl::StatusOr<Volume> RasterizeLayers(std::span<const Solid> solids, double scale,
                                       const ChooseLayer& chosen);

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_RASTERIZE_H_
