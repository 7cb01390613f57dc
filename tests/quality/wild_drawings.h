#ifndef BCCSKEL_TESTS_QUALITY_WILD_DRAWINGS_H_
#define BCCSKEL_TESTS_QUALITY_WILD_DRAWINGS_H_

#include "tests/quality/wild_figures.h"

// Functions that draw the figures of wild_figures.cc, each part in a file of its name.

namespace bccskel::quality {

// ---- wild_growth.cc
// Figures whose parts grow and must not touch each other.

// A cell body with dendrites that fork: their count, length in radii of the body, radii in steps.
Sketch Soma(Pen pen, const WildFigure::Values& values);
// Tubes between random places: how many places, edge of their box in radii, largest degree.
Sketch Network(Pen pen, const WildFigure::Values& values);
// One of the figures of the report that are made of round cones.
Sketch Round(Pen pen, const WildFigure::Values& values);

// ---- wild_parts.cc
// Figures that end abruptly: cut flat, or close behind the last thing that leaves them.

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

// ---- wild_sheets.cc
// Plates and thin-walled parts. Nobody can say how many ends they should have, but it is the same
// number in all poses and at all sizes: nothing about them but a casting's bosses is random, and
// walls are as thick as their figure is large. All lengths are in the first one named, which grows
// with the object.

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

#endif  // BCCSKEL_TESTS_QUALITY_WILD_DRAWINGS_H_
