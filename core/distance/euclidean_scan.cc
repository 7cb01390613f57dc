#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "core/distance/border_bricks.h"
#include "core/distance/chamfer_rows.h"
#include "core/distance/euclidean_parts.h"
#include "core/distance/euclidean_rows.h"
#include "core/volume/brick_neighbors.h"

// Does:  exact squared Euclidean distance to the background for every point of the stored bricks.
// Paper: goes beyond it; section 4 uses chamfer distances.
// Why it is right: the square of a distance is a sum over the axes, so the minimum can be found
//   axis by axis. Background of either sublattice may be the nearest. So for each layer of a
//   sublattice, distances within the layer are measured at two kinds of positions: its own points,
//   and the positions between them that lie above and below points of the other sublattice. The
//   scan along z then takes the minimum of layer distance plus squared height, over layers of both
//   kinds.
// Bricks that are not stored are background: next to them the nearest background of a layer is one
// step away along both axes. A scan ends at the first background point of its own column, since
// everything beyond is farther. The same holds in a window: the nearest point lies in the window,
// and so do all positions on the way.
// Cost:  as much memory again as the squares, and an eighth. One or two rows of 16 points search
//        outward together until no point can find anything nearer: about a step per lattice unit of
//        distance, each of two or three cycles for all of them. Columns of floats, which objects
//        deeper than 254 units have, are searched by bisection where they are deep.

namespace bccskel {
namespace {

// Positions in a BrickNeighborhood.
constexpr size_t kAboveX = 8, kBelowX = 9, kAboveY = 10, kBelowY = 11, kAboveZ = 12, kBelowZ = 13;

uint16_t LargestIn(std::span<const uint16_t> squares) { return LargestOf(squares); }
float LargestIn(std::span<const float> squares) {
  uint32_t largest = 0;  // integers, so that the loop vectorizes
  for (const float square : squares) largest = std::max(largest, std::bit_cast<uint32_t>(square));
  return std::bit_cast<float>(largest);
}

void RaiseTo(float value, std::atomic<float>& largest) {
  float seen = largest;
  while (seen < value && !largest.compare_exchange_weak(seen, value)) {
  }
}

bool IsUnknownBeside(const Volume& object, BrickIndex n, size_t position) {
  return object.neighbors()[n][position] == object.brick_count() &&
         object.IsUnknown(
             NeighborBrick(object.keys()[n].coordinates(), static_cast<int>(position)));
}

template <typename T>
class EuclideanScan {
 public:
  EuclideanScan(const Volume& object, EuclideanParts<T>& parts)
      : object_(object),
        view_{object.padded_bricks().data(), object.neighbors().data(),
              static_cast<BrickIndex>(object.brick_count()), parts.own.data(),
              parts.beside.data()} {
    MeasureSteps();
  }

  void RunWithinLayers(exec::Share wanted, const SideRuns<uint32_t>& runs,
                       const exec::Context& context) {
    Share(context, wanted.end - wanted.begin, 256, [&](size_t n) { FillBeside(wanted.begin + n); });
    std::vector<BrickIndex> feet = StackFeet(kBelowY);
    std::erase_if(feet, [&](BrickIndex foot) {
      const LayersOfBrick layers = LayersFor(wanted, foot);
      return layers.first == layers.end;
    });
    Share(context, feet.size(), 1, [&](size_t n) {
      const BrickIndex foot = feet[n];
      const std::vector<BrickIndex> stack = StackFrom(foot, kAboveY);
      ScanLayers(view_, lengths_, SublatticeOf(foot), stack, EndsOf(stack, kBelowY, kAboveY),
                 LayersFor(wanted, foot), runs);
    });
  }

  float RunAcrossLayers(const exec::Context& context, const std::function<void(BrickStack)>& done) {
    std::atomic<float> largest = 0;
    const std::vector<BrickIndex> feet = StackFeet(kBelowZ);
    Share(context, feet.size(), 1, [&](size_t n) {
      const BrickIndex foot = feet[n];
      const std::vector<BrickIndex> stack = StackFrom(foot, kAboveZ);
      ScanAcrossLayers(view_, lengths_, SublatticeOf(foot), stack, EndsOf(stack, kBelowZ, kAboveZ));
      RaiseTo(LargestOfStack(stack), largest);
      done(stack);
    });
    return largest;
  }

 private:
  static constexpr size_t kSamePlace = 0, kAcrossZ = 4;
  static constexpr size_t kScanWork = 16;  // in the unit of Context::WorkersFor()
  // Some steps past the end of a stack: rows along y are two apart.
  static constexpr size_t kFartherThanStack = 4 * kMostEndRows<T>;

  // Distributes the items among the workers, which ask before every `at_once` of them whether to
  // stop.
  template <typename Work>
  void Share(const exec::Context& context, size_t count, size_t at_once, Work work) const {
    const int workers = context.WorkersFor(object_.brick_count(), kScanWork);
    (void)context.ForEach(workers, count, at_once, [&](int) { return std::ref(work); });
  }

  float LargestOfStack(BrickStack stack) const {
    float most = 0;
    for (const BrickIndex n : stack) {
      const T* squares = view_.own + size_t{n} * kBrickPoints;
      most = std::max(most, static_cast<float>(LargestIn(std::span(squares, kBrickPoints))));
    }
    return most;
  }

  std::vector<BrickIndex> StackFrom(BrickIndex foot, size_t onward) const {
    std::vector<BrickIndex> stack;
    for (BrickIndex n = foot; n != view_.padding; n = view_.neighbors[n][onward]) {
      stack.push_back(n);
    }
    return stack;
  }

  StackEnds EndsOf(BrickStack stack, size_t back, size_t onward) const {
    if (!object_.window().has_value()) return {};
    return {IsUnknownBeside(object_, stack.front(), back),
            IsUnknownBeside(object_, stack.back(), onward)};
  }

  Sublattice SublatticeOf(BrickIndex n) const { return object_.keys()[n].sublattice(); }

  // The layers of a stack that write squares of wanted bricks: of the stacks below and above, only
  // the layer of the other sublattice that touches them.
  LayersOfBrick LayersFor(exec::Share wanted, BrickIndex foot) const {
    const bool is_odd = SublatticeOf(foot) == Sublattice::kOdd;
    constexpr size_t kLayers = kBrickZ;
    if (foot < wanted.begin) return {is_odd ? kLayers - 1 : kLayers, kLayers};
    if (foot >= wanted.end) return {0, is_odd ? size_t{0} : size_t{1}};
    return {};
  }

  // The first brick of each stack.
  std::vector<BrickIndex> StackFeet(size_t back) const {
    std::vector<BrickIndex> feet;
    for (BrickIndex n = 0; n < object_.brick_count(); ++n) {
      if (view_.neighbors[n][back] == view_.padding) feet.push_back(n);
    }
    return feet;
  }

  size_t LongestStack(size_t back, size_t onward) const {
    size_t longest = 0;
    for (const BrickIndex foot : StackFeet(back)) {
      longest = std::max(longest, StackFrom(foot, onward).size());
    }
    return longest;
  }

  // Computes squares for the longest stacks: no scan looks farther than its stack is long.
  void MeasureSteps() {
    const AxisScale scale = AxisScaleOf(object_.placement());
    lengths_.x = Square(scale[0]);
    lengths_.y =
        Squares(scale[1], 2 * kBrickY * LongestStack(kBelowY, kAboveY) + kFartherThanStack);
    lengths_.z =
        Squares(scale[2], 2 * kBrickZ * LongestStack(kBelowZ, kAboveZ) + kFartherThanStack);
  }

  static T Square(double length) {
    const double most = static_cast<double>(std::numeric_limits<T>::max());
    return static_cast<T>(std::min(length * length, most));
  }
  static std::vector<T> Squares(double unit, size_t count) {
    std::vector<T> squares(count);
    for (size_t n = 0; n < count; ++n) squares[n] = Square(unit * static_cast<double>(n));
    return squares;
  }

  // Fills the positions that no brick of the other sublattice writes.
  void FillBeside(size_t brick) const {
    const T one_step = static_cast<T>(lengths_.x + lengths_.y[1]);
    const auto nearest = [&](size_t position) {
      const bool is_unknown = object_.window().has_value() &&
                              IsUnknownBeside(object_, static_cast<BrickIndex>(brick), position);
      return is_unknown ? std::numeric_limits<T>::max() : one_step;
    };
    T* layers = view_.beside + brick * kLayersBeside * kLayerPoints;
    if (view_.neighbors[brick][kSamePlace] == view_.padding) {
      std::fill_n(layers, kBrickZ * kLayerPoints, nearest(kSamePlace));
    }
    if (view_.neighbors[brick][kAcrossZ] == view_.padding) {
      std::fill_n(layers + kBrickZ * kLayerPoints, kLayerPoints, nearest(kAcrossZ));
    }
  }

  const Volume& object_;
  const EuclideanView<T> view_;
  SquaredLengths<T> lengths_;
};

// Whether a brick is surrounded by full bricks as far as the background of a point whose 16-bit
// square would be unsure. Only decides what to try first.
bool IsDeepInside(const Volume& object, BrickIndex brick) {
  // Positions in a BrickNeighborhood, and how many bricks that way have no point farther than 255
  // units from any point of the brick.
  static constexpr struct {
    size_t direction;
    int bricks;
  } kReaches[] = {{kAboveZ, 14}, {kBelowZ, 14}, {kAboveX, 6},
                  {kBelowX, 6},  {kAboveY, 30}, {kBelowY, 30}};
  for (const auto& [direction, bricks] : kReaches) {
    BrickIndex n = brick;
    for (int step = 0; step <= bricks; ++step, n = object.neighbors()[n][direction]) {
      if (!IsFull(object.padded_bricks()[n])) return false;
    }
  }
  return true;
}

}  // namespace

bool IsDeep(const Volume& object, std::span<const BrickIndex> bricks) {
  return std::ranges::any_of(bricks, [&](BrickIndex n) { return IsDeepInside(object, n); });
}
bool IsDeep(const Volume& object) {
  std::vector<BrickIndex> all(object.brick_count());
  std::iota(all.begin(), all.end(), BrickIndex{0});
  return IsDeep(object, all);
}

template <typename T>
void MeasureWithinLayers(const Volume& object, exec::Share wanted, const SideRuns<uint32_t>& runs,
                         const exec::Context& context, EuclideanParts<T>& parts) {
  EuclideanScan<T>(object, parts).RunWithinLayers(wanted, runs, context);
}
template <typename T>
float MeasureAcrossLayers(const Volume& object, const exec::Context& context,
                          EuclideanParts<T>& parts, const std::function<void(BrickStack)>& done) {
  return EuclideanScan<T>(object, parts).RunAcrossLayers(context, done);
}

template void MeasureWithinLayers(const Volume&, exec::Share, const SideRuns<uint32_t>&,
                                  const exec::Context&, EuclideanParts<uint16_t>&);
template void MeasureWithinLayers(const Volume&, exec::Share, const SideRuns<uint32_t>&,
                                  const exec::Context&, EuclideanParts<float>&);
template float MeasureAcrossLayers(const Volume&, const exec::Context&, EuclideanParts<uint16_t>&,
                                   const std::function<void(BrickStack)>&);
template float MeasureAcrossLayers(const Volume&, const exec::Context&, EuclideanParts<float>&,
                                   const std::function<void(BrickStack)>&);

}  // namespace bccskel
