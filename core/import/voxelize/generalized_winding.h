#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_GENERALIZED_WINDING_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_GENERALIZED_WINDING_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/import/voxelize/row_fill.h"

namespace bccskel {

// Does:  fills an open surface where its generalized winding number (Jacobson, Kavan,
//        Sorkine-Hornung 2013) exceeds 1/2.
// Why it is right: winding numbers add. Surface and caps together are closed, so their sum is the
//        integer that the rays count; subtracting the solid angles of the caps alone leaves the
//        winding number of the open surface, at the price of the boundary instead of every
//        triangle. Between crossings of a row the caps' part is smooth; its gradient is at most
//        the sum over the boundary edges of the smaller of length / (4 pi distance^2) and
//        2 / (4 pi distance) (the law of Biot and Savart), so one value may decide a whole segment.
// Cost:  per segment a few halvings beside the boundary; per value the triangles of the caps nearby
//        and the logarithm of the others, since a part of a cap seen from more than 4 of its radii
//        away counts as a dipole (Barill et al. 2018), error below 10^-3.
// Ties:  on a cap the solid angle jumps by 4 pi; its side is found exactly, as for the rays.
//        A value of 1/2, as in the plane of a hole, is outside; 10^-9 keep rounding out of it.
class GeneralizedWindingRule : public SegmentRule {
 public:
  using Vector = std::array<double, 3>;

  // Shapes: `vertices` in ticks as for the rays; `loops` of them, see BoundaryLoops(). `sign` is
  //         the sense (+1 or -1) of the surface and its caps.
  GeneralizedWindingRule(std::span<const GridPoint> vertices,
                         std::span<const std::vector<uint32_t>> loops, const LatticeExtent& extent,
                         int sign);

  void Append(const LatticeRow& row, CellSpan segment, int winding, int crossings,
              std::vector<CellSpan>& inside) const override;
  // The boxes of the caps: a bulging cap can have inside points on its outer side.
  std::span<const Region> extra_regions() const override { return regions_; }

 private:
  // What closes a part of a loop by a chord (see ForEachTriangleOfCap()): a triangle and the
  // patches beyond its first two sides.
  struct Patch {
    std::array<Vector, 3> corners = {};
    std::array<int32_t, 2> beyond = {kEdge, kEdge};  // in patches_
    Vector middle = {};                              // weighted by area
    double radius = 0;
    Vector dipole = {};  // area vector / (4 pi)
    double area = 0;
    double length = 0;    // of the part of the loop
    bool is_cap = false;  // the whole loop, whose chord is an edge of the boundary, too
  };
  static constexpr int32_t kEdge = -1;  // no patch: an edge of the boundary

  // The caps' winding number at a point and a bound on its change within a distance.
  struct Field {
    double value = 0;
    double change = 0;
  };

  int32_t AddPatch(std::span<const Vector> loop);
  static Region BoxOf(std::span<const Vector> loop, const LatticeExtent& extent);
  void AddField(int32_t patch, const Vector& p, double reach, Field& field) const;
  Field CapField(const Vector& p, double reach) const;
  void Decide(const LatticeRow& row, CellSpan segment, int winding,
              std::vector<CellSpan>& inside) const;

  std::vector<Patch> patches_;
  std::vector<int32_t> caps_;  // in patches_
  std::vector<Region> regions_;
  int sign_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_GENERALIZED_WINDING_H_
