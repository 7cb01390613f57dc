#include "tests/client/export/sample_skeletons.h"

#include <sstream>
#include <utility>

namespace bccskel::exporting {

SkeletonGraph Lollipop() {
  SkeletonGraph graph;
  graph.placement.spacing = {2, 2, 2};
  graph.placement.origin = {10, 20, 30};
  const SkeletonPoint end = {{0, 0, 0}, 2}, junction = {{2, 2, 2}, 4};
  graph.nodes = {{NodeKind::kEnd, end},
                 {NodeKind::kJunction, junction},
                 {NodeKind::kIsolated, {{10, 10, 10}, 2}}};
  graph.points = {end,     {{1, 1, 1}, 3}, junction, junction, {{3, 3, 3}, 2}, {{4, 2, 2}, 2},
                  junction};
  graph.edges = {{0, 1, 0, 3}, {1, 1, 3, 4}};
  return graph;
}

Sample SampleOf(Shape shape, uint64_t points) {
  Volume object = *GenerateShape(shape, {.points = points});
  SkeletonizeResult result = *Skeletonize(object, {}, {});
  return {std::move(object), std::move(result)};
}

std::vector<Sample> Samples() {
  std::vector<Sample> samples;
  for (const Shape shape : {Shape::kTree, Shape::kTorus, Shape::kHollowBall, Shape::kBall}) {
    samples.push_back(SampleOf(shape));
  }
  return samples;
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> WordsOf(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

}  // namespace bccskel::exporting
