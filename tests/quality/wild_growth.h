#ifndef BCCSKEL_TESTS_QUALITY_WILD_GROWTH_H_
#define BCCSKEL_TESTS_QUALITY_WILD_GROWTH_H_

#include "tests/quality/wild_figures.h"

// Figures whose parts grow and must not touch each other.

namespace bccskel::quality {

// A cell body with dendrites that fork: their count, length in radii of the body, radii in steps.
Sketch Soma(Pen pen, const WildFigure::Values& values);
// Tubes between random places: how many places, edge of their box in radii, largest degree.
Sketch Network(Pen pen, const WildFigure::Values& values);
// One of the figures of the report that are made of round cones.
Sketch Round(Pen pen, const WildFigure::Values& values);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_WILD_GROWTH_H_
