#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_POINT_SET_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_POINT_SET_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/directions.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"
#include "tests/support/volume_where.h"

namespace bccskel::test {

// A finite point set as one byte per integer coordinate of its bounding box, with a margin of two
// background cells on each side. Slow and plain on purpose: the oracle of the bit bricks.
class ReferencePointSet {
 public:
  static constexpr int32_t kMargin = 2;

  explicit ReferencePointSet(std::span<const LatticePoint> points);
  explicit ReferencePointSet(const Volume& volume);

  bool Contains(LatticePoint p) const { return InBox(p) && inside_[Index(p)] != 0; }
  // Needs: p lies in the bounding box of the points given at construction.
  void Insert(LatticePoint p) { inside_[Index(p)] = 1; }
  // Needs: as Insert().
  void Erase(LatticePoint p) { inside_[Index(p)] = 0; }

  // The neighbors of p in the set, by looking each of them up.
  NeighborMask NeighborsOf(LatticePoint p) const;
  // All points in lattice order (z, then y, then x).
  std::vector<LatticePoint> SortedPoints() const;

  // The box with its margin, and the place of a coordinate in an array over it.
  bool InBox(LatticePoint p) const;
  size_t Index(LatticePoint p) const;  // Needs: InBox(p).
  size_t box_size() const { return inside_.size(); }
  LatticePoint low() const { return low_; }    // first coordinates of the box
  LatticePoint high() const { return high_; }  // last coordinates of the box

  // Calls visit(LatticePoint) for all lattice points of the box, object or not, in lattice order.
  template <typename Visit>
  void ForEachLatticePointOfBox(Visit visit) const {
    ForEachPointIn({low_, high_}, visit);
  }

 private:
  LatticePoint low_;
  LatticePoint high_;
  std::vector<uint8_t> inside_;
};

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_POINT_SET_H_
