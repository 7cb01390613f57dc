#ifndef BCCSKEL_TESTS_QUALITY_STUDIES_H_
#define BCCSKEL_TESTS_QUALITY_STUDIES_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"

// What the report is made of. Each study prints one JSON object a line.

namespace bccskel::quality {

struct StudySize {
  uint64_t points = 100'000;  // of an object
  int turns = 3;              // random rotations of each figure
};

// Every figure, noise and method against the truth.
absl::Status StudyFigures(const StudySize& size);
// The figures as voxels, converted exactly: with the margin of the slope rule for voxels, and with
// that for surfaces sampled point by point.
absl::Status StudyMasks(const StudySize& size);
// How much skeletons change when the grid, or the figure on it, is turned.
absl::Status StudyRotations(const StudySize& size);
// The union of the balls against the object, for curve and surface skeletons.
absl::Status StudyReconstruction(const StudySize& size);
// A real mesh, clean and with noise.
absl::Status StudyMesh(const StudySize& size, const std::string& path);
// The figures on the cubic grid with as many voxels, for other tools: a line of JSON that tells the
// truth in voxels, then a bit per voxel, x fastest, lowest bit first.
absl::Status PrintVoxels(const StudySize& size);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_STUDIES_H_
