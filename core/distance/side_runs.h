#ifndef BCCSKEL_CORE_DISTANCE_SIDE_RUNS_H_
#define BCCSKEL_CORE_DISTANCE_SIDE_RUNS_H_

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {

// For each of a brick's 32 rows, how many points can be walked from one side without meeting
// background, in this brick and the ones before it. Row 4k + j.
template <typename T>
using RowRuns = std::array<T, 4 * kBrickZ>;

template <typename T>
struct SideRuns {
  std::vector<RowRuns<T>> left;   // at the brick's left side
  std::vector<RowRuns<T>> right;  // at its right side

  explicit SideRuns(size_t bricks) : left(bricks), right(bricks) {}
};

inline uint16_t RowBits(const BrickBits& brick, size_t row) {
  return static_cast<uint16_t>(brick.words[row >> 2] >> (16 * (row & 3)));
}

inline uint32_t Shorter(uint32_t run, uint32_t longest) { return run < longest ? run : longest; }

// The run lengths at the far side of a brick, given those at its near side.
template <typename T, typename RunInRow>
void ContinueRuns(const BrickBits& brick, uint32_t longest, const RowRuns<T>& near_side,
                  RowRuns<T>& far_side, RunInRow run_in_row) {
  for (size_t row = 0; row < far_side.size(); ++row) {
    const uint16_t bits = RowBits(brick, row);
    far_side[row] =
        static_cast<T>(bits == 0xffff ? Shorter(near_side[row] + uint32_t{kBrickX}, longest)
                                      : static_cast<uint32_t>(run_in_row(bits)));
  }
}

// Computes the runs beside the bricks [first, last), none longer than `longest`.
// Shapes: runs[0] belongs to brick `origin`; all are 0, except where no brick lies beside a brick
//         and another run shall begin.
// Needs: the bricks are whole layers of bricks (all of one bz), in the order of a Volume.
template <typename T>
void FindSideRuns(const BrickBits* object, const BrickNeighborhood* neighbors, BrickIndex first,
                  BrickIndex last, uint32_t longest, BrickIndex origin, SideRuns<T>& runs) {
  for (BrickIndex brick = first; brick < last; ++brick) {
    const BrickIndex left = neighbors[brick][9];
    if (left < first || left >= brick) continue;
    ContinueRuns(object[left], longest, runs.left[left - origin], runs.left[brick - origin],
                 [](uint16_t bits) { return std::countl_one(bits); });
  }
  for (BrickIndex brick = last; brick-- > first;) {
    const BrickIndex right = neighbors[brick][8];
    if (right <= brick || right >= last) continue;
    ContinueRuns(object[right], longest, runs.right[right - origin], runs.right[brick - origin],
                 [](uint16_t bits) { return std::countr_one(bits); });
  }
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_SIDE_RUNS_H_
