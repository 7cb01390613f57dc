#include "core/certificate/brick_components.h"

#include <bit>
#include <vector>

#include "core/certificate/neighbor_planes.h"

namespace bccskel {
namespace {

constexpr BrickBits kNothing;

// In which of the six D6 directions each point has a neighbor inside the brick.
struct InnerNeighbors {
  std::array<BrickBits, 2> x, y, z;
};

InnerNeighbors FindInnerNeighbors(const BrickBits& points) {
  return {{TakePrevious<Axis::kX>(points, kNothing), TakeNext<Axis::kX>(points, kNothing)},
          {TakePrevious<Axis::kY>(points, kNothing), TakeNext<Axis::kY>(points, kNothing)},
          {TakePrevious<Axis::kZ>(points, kNothing), TakeNext<Axis::kZ>(points, kNothing)}};
}

BrickBits Without(const BrickBits& points, const BrickBits& a, const BrickBits& b,
                  const BrickBits& c) {
  BrickBits left;
  for (size_t k = 0; k < 8; ++k) {
    left.words[k] = points.words[k] & ~(a.words[k] | b.words[k] | c.words[k]);
  }
  return left;
}

BrickBits Without(const BrickBits& points, const BrickBits& a) {
  return Without(points, a, kNothing, kNothing);
}

bool HasOnePoint(const BrickBits& points) {
  uint64_t more = 0;
  int words = 0;
  for (uint64_t word : points.words) {
    more |= word & (word - 1);
    words += word != 0 ? 1 : 0;
  }
  return more == 0 && words == 1;
}

BrickBits FirstPoint(const BrickBits& points) {
  BrickBits first;
  for (size_t k = 0; k < 8; ++k) {
    if (points.words[k] == 0) continue;
    first.words[k] = points.words[k] & (~points.words[k] + 1);
    break;
  }
  return first;
}

// Spreads `seed` within runs of `open` along x and y, by doubling steps.
uint64_t SpreadInWord(uint64_t seed, uint64_t open) {
  uint64_t up = open & ~planes_internal::kFirstOfLane;
  uint64_t down = open & ~planes_internal::kLastOfLane;
  for (int step = 1; step < 16; step *= 2) {
    seed |= (up & (seed << step)) | (down & (seed >> step));
    up &= up << step;
    down &= down >> step;
  }
  uint64_t left = open, right = open;
  for (int step = 16; step < 64; step *= 2) {
    seed |= (left & (seed << step)) | (right & (seed >> step));
    left &= left << step;
    right &= right >> step;
  }
  return seed;
}

// The component of `seed` in `open`.
BrickBits Flood(BrickBits seed, const BrickBits& open) {
  for (;;) {
    const BrickBits before = seed;
    for (size_t k = 0; k < 8; ++k) {
      const uint64_t below = k > 0 ? seed.words[k - 1] : 0;
      seed.words[k] = SpreadInWord(seed.words[k] | (below & open.words[k]), open.words[k]);
    }
    for (size_t k = 7; k-- > 0;) {
      seed.words[k] =
          SpreadInWord(seed.words[k] | (seed.words[k + 1] & open.words[k]), open.words[k]);
    }
    if (seed == before) return seed;
  }
}

// All components with more than one point, then one for each point without a neighbor.
std::vector<BrickBits> FindComponents(const BrickBits& points) {
  const InnerNeighbors near = FindInnerNeighbors(points);
  BrickBits lonely = Without(points, near.x[0], near.y[0], near.z[0]);
  lonely = Without(lonely, near.x[1], near.y[1], near.z[1]);
  std::vector<BrickBits> components;
  for (BrickBits rest = Without(points, lonely); !rest.Empty();) {
    components.push_back(Flood(FirstPoint(rest), rest));
    rest = Without(rest, components.back());
  }
  lonely.ForEachSetBit([&](int bit) { components.emplace_back().Set(bit); });
  return components;
}

size_t LargestOf(const std::vector<BrickBits>& components) {
  size_t largest = 0;
  uint64_t points = 0;
  for (size_t n = 0; n < components.size(); ++n) {
    const uint64_t count = components[n].Count();
    if (count > points) {
      largest = n;
      points = count;
    }
  }
  return largest;
}

}  // namespace

// From every point walk down against the signs sx, sy, sz as long as there is a neighbor: all walks
// end at points without a neighbor that way. If there is only one such point, all are connected to
// it. The part of a smooth object in a brick passes for the signs of its surface's normal.
bool IsPlainlyConnected(const BrickBits& points) {
  const InnerNeighbors near = FindInnerNeighbors(points);
  for (size_t signs = 0; signs < 8; ++signs) {
    if (HasOnePoint(
            Without(points, near.x[signs & 1], near.y[(signs >> 1) & 1], near.z[signs >> 2]))) {
      return true;
    }
  }
  return false;
}

BrickFragments SplitBrick(const BrickBits& points) {
  const std::vector<BrickBits> components = FindComponents(points);
  const size_t main = LargestOf(components);
  BrickFragments split;
  split.fragments = Without(points, components[main]);
  split.components = static_cast<int>(components.size());
  uint8_t label = 0;
  for (size_t n = 0; n < components.size(); ++n) {
    if (n == main) continue;
    ++label;
    components[n].ForEachSetBit([&](int bit) { split.labels[static_cast<size_t>(bit)] = label; });
  }
  return split;
}

}  // namespace bccskel
