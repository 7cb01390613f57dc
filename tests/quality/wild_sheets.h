#ifndef BCCSKEL_TESTS_QUALITY_WILD_SHEETS_H_
#define BCCSKEL_TESTS_QUALITY_WILD_SHEETS_H_

#include "tests/quality/wild_figures.h"

// Plates and thin-walled parts. Nobody can say how many ends they should have, but it is the same
// number in all poses and at all sizes: nothing about them but a casting's bosses is random, and
// walls are as thick as their figure is large. All lengths are in the first one named, which grows
// with the object.

namespace bccskel::quality {

// A plate, a disk or a lens: 0 to 2, width by thickness.
Sketch Plate(Pen pen, const WildFigure::Values& values);
// A block with bosses, cut flat, on one side: their count, their height.
Sketch Casting(Pen pen, const WildFigure::Values& values);
// A plate that is bent to a part of a tube: angle, length in radii of the bend, thickness.
Sketch BentPlate(Pen pen, const WildFigure::Values& values);
// Beams of walls as wide as each other: walls (2: L, 3: T, 4: Z and a third, so U, 5: double T),
// length, thickness.
Sketch Profile(Pen pen, const WildFigure::Values& values);
// A box without a lid: height in half edges of the bottom, thickness, width by length.
Sketch OpenBox(Pen pen, const WildFigure::Values& values);
// A tube with rings around its ends: length in radii, thickness, width of the rings, their count.
Sketch FlangedTube(Pen pen, const WildFigure::Values& values);
// A plate with square holes: their count along and across, their edge, thickness.
Sketch PerforatedPlate(Pen pen, const WildFigure::Values& values);
// A plate with ribs across it: their count, height in half edges of the plate, thickness.
Sketch RibbedPlate(Pen pen, const WildFigure::Values& values);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_WILD_SHEETS_H_
