#ifndef BCCSKEL_CORE_SHAPES_FIGURES_H_
#define BCCSKEL_CORE_SHAPES_FIGURES_H_

#include <cstdint>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/shapes/solids.h"

namespace bccskel::shapes {

// The solids whose union is the shape, in figure units.
std::vector<Solid> FigureOf(Shape shape, uint64_t seed);

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_SHAPES_FIGURES_H_
