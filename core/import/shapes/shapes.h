#ifndef BCCSKEL_CORE_IMPORT_SHAPES_SHAPES_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_SHAPES_H_

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/volume/layer_part.h"
#include "core/volume/volume.h"

namespace bccskel {

// Generated objects for tests, benchmarks and the command line. Components, loops and cavities hold
// without noise; noise may add tiny ones of each.
enum class Shape : uint8_t {
  kBall,        // 1, 0, 0
  kTorus,       // 1, 1, 0: ring radius 2.6 tube radii
  kTubes,       // 1, 0, 0: eight thin tips, about 1.4 % of the box
  kBlob,        // 1, 0, 0: random balls that share a point
  kHorse,       // 1, 0, 0: twelve spheroids
  kTree,        // 1, 0, 0: 33 tips of tapered branches
  kKnot,        // 1, 1, 0: tube along a trefoil
  kBox,         // 1, 0, 0: edges 3 : 2 : 1
  kHollowBall,  // 1, 0, 1: inner radius half the outer
};
inline constexpr std::array<Shape, 9> kShapes = {Shape::kBall, Shape::kTorus, Shape::kTubes,
                                                 Shape::kBlob, Shape::kHorse, Shape::kTree,
                                                 Shape::kKnot, Shape::kBox,   Shape::kHollowBall};

inline constexpr uint64_t kMinShapePoints = 5'000;
inline constexpr uint64_t kMaxShapePoints = uint64_t{1} << 33;
inline constexpr double kMaxShapeNoise = 0.1;

struct ShapeOptions {
  // Wanted number of object points; the shape is scaled to have within 3 % of it.
  uint64_t points = 850'000;
  // Choses the random parts: branches, balls, noise.
  uint64_t seed = 0;
  // Fraction of the points on either side of the boundary that change sides.
  double noise = 0;
};

// "ball", "torus", "tubes", "blob", "horse", "tree", "knot", "box", "hollow-ball".
std::string_view ShapeName(Shape shape);
// Errors: INVALID_ARGUMENT that lists the names.
absl::StatusOr<Shape> ParseShapeName(std::string_view name);

// The same points on every machine for the same arguments: only + - * / and sqrt decide.
// Errors: INVALID_ARGUMENT, with the value and the limit.
// Cost:   time and memory follow the object, not its box.
absl::StatusOr<Volume> GenerateShape(Shape shape, const ShapeOptions& options);

// The sum of all parts' numbers, for each of them.
using SumOfParts = std::function<uint64_t(uint64_t)>;
// GenerateShape() by several at a time, each of which gets the bricks of its layers. All of them
// call `sum` equally often.
absl::StatusOr<Volume> GenerateShapePart(Shape shape, const ShapeOptions& options,
                                         const LayerPart& part, const SumOfParts& sum);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_SHAPES_H_
