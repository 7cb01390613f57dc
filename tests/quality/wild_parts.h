#ifndef BCCSKEL_TESTS_QUALITY_WILD_PARTS_H_
#define BCCSKEL_TESTS_QUALITY_WILD_PARTS_H_

#include "tests/quality/wild_figures.h"

// Figures that end abruptly: cut flat, or close behind the last thing that leaves them.

namespace bccskel::quality {

// A ring, or a bar, with teeth cut flat, as wide as it is thick: their count, width by thickness,
// how far they stick out, in half their widths, ring or bar.
Sketch Teeth(Pen pen, const WildFigure::Values& values);
// A strip with square ends: length by width, width by thickness.
Sketch Strip(Pen pen, const WildFigure::Values& values);
// A shaft with wheels: their count, radius in radii of the shaft, thickness by that radius.
Sketch Axle(Pen pen, const WildFigure::Values& values);
// A trunk with a twig close before one of its ends: from the middle of the twig to the surface of
// that end, radius and length of the twig, all in radii of the trunk.
Sketch Trunk(Pen pen, const WildFigure::Values& values);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_WILD_PARTS_H_
