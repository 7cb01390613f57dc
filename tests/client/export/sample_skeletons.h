#ifndef BCCSKEL_TESTS_CLIENT_EXPORT_SAMPLE_SKELETONS_H_
#define BCCSKEL_TESTS_CLIENT_EXPORT_SAMPLE_SKELETONS_H_

#include <string>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// By hand: an end, a stem to a junction, a loop of three steps on the junction, an isolated point.
// Origin (10, 20, 30) and spacing 2, so that a lattice unit is a world unit.
SkeletonGraph Lollipop();

// A generated object and its skeleton.
struct Sample {
  Volume object;
  SkeletonizeResult result;
};
Sample SampleOf(Shape shape, uint64_t points = 5000);

// One per kind of topology: a tree, a loop without junction, a cavity, one point.
std::vector<Sample> Samples();

// Lines without their ends.
std::vector<std::string> LinesOf(const std::string& text);
// Words between blanks.
std::vector<std::string> WordsOf(const std::string& line);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_TESTS_CLIENT_EXPORT_SAMPLE_SKELETONS_H_
