#ifndef BCCSKEL_TESTS_QUALITY_STUDIES_H_
#define BCCSKEL_TESTS_QUALITY_STUDIES_H_

#include "absl/status/status.h"
#include "tests/quality/study_options.h"

// What the report is made of. Each study prints one JSON object a line; those with a --json without
// it a table.

namespace bccskel::quality {

// Every figure, noise and method against the truth.
absl::Status StudyFigures(const StudyOptions& options);
// How much skeletons change when the grid, or the figure on it, is turned.
absl::Status StudyRotations(const StudyOptions& options);
// The union of the balls against the object, for curve and surface skeletons.
absl::Status StudyReconstruction(const StudyOptions& options);
// A real mesh, clean and with noise.
absl::Status StudyMesh(const StudyOptions& options);
// Figures as people have them: spines, flat parts, networks, cuts, as bcc objects or as masks.
absl::Status StudyWild(const StudyOptions& options);
// The mask of a ball of a radius of 20 voxels with six spines along the axes, of a radius of 2 and
// of growing length: how many ends there are.
absl::Status StudySpineLengths(const StudyOptions& options);
// Tubes with round caps in random directions, as masks whose slices are 1 to 8 times as thick as
// voxels are wide: ends, and how far they and the curves are off.
absl::Status StudyThickSlices(const StudyOptions& options);
// Straight limbs that the border of an image cuts off, at a slant: how far from the middles of the
// cuts their curves end.
absl::Status StudyCutLimbs(const StudyOptions& options);
// Images that limbs cross in all directions, and figures in the boxes of their voxels, with each
// choice of what lies beyond the border: which cuts have an end, and which crops have other ends.
absl::Status StudyImageFaces(const StudyOptions& options);
// The real masks of the reference data: ends, twigs, redundant length, missed parts.
absl::Status StudyRealMasks(const StudyOptions& options);
// The closed meshes of the reference data at several sizes, and turned.
absl::Status StudyClosedMeshes(const StudyOptions& options);
// The figures on the cubic grid with as many voxels, for other tools: a line of JSON that tells the
// truth in voxels, then a bit per voxel, x fastest, lowest bit first.
absl::Status PrintVoxels(const StudyOptions& options);
// The real masks in the same way, with the spacing of their voxels.
absl::Status PrintRealVoxels(const StudyOptions& options);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_STUDIES_H_
