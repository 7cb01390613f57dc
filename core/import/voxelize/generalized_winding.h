#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_GENERALIZED_WINDING_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_GENERALIZED_WINDING_H_

#include <array>
#include <span>
#include <vector>

#include "core/import/mesh/triangle_mesh.h"
#include "core/import/voxelize/boundary_caps.h"
#include "core/import/voxelize/row_fill.h"

namespace bccskel {

// Does:  fills an open surface where its generalized winding number (Jacobson, Kavan,
//        Sorkine-Hornung 2013) exceeds 1/2.
// Why it is right: winding numbers add. Surface and caps together are closed, so their sum is the
//        integer that the rays count; subtracting the solid angles of the caps alone leaves the
//        winding number of the open surface, at the price of the boundary instead of every
//        triangle. Between crossings of a row the caps' part is smooth; its gradient is at most
//        the sum of length / (4 pi distance^2) over the boundary edges (the law of Biot and
//        Savart), so one value may decide a whole segment.
// Cost:  per segment the near boundary edges, times a few halvings beside them. A cap seen from
//        more than 4 of its radii away counts as a dipole (Barill et al. 2018), error below 10^-3.
// Ties:  on a cap the solid angle jumps by 4 pi; its side is found exactly, as for the rays.
//        A value of 1/2, as in the plane of a hole, is outside; 10^-9 keep rounding out of it.
class GeneralizedWindingRule : public SegmentRule {
 public:
  using Vector = std::array<double, 3>;

  // Shapes: `vertices` in ticks as for the rays, apexes included. `sign` is the sense (+1 or -1) of
  //         the surface and its caps.
  GeneralizedWindingRule(std::span<const GridPoint> vertices, const BoundaryCaps& caps,
                         const LatticeExtent& extent, int sign);

  void Append(const LatticeRow& row, CellSpan segment, int winding, int crossings,
              std::vector<CellSpan>& inside) const override;
  // The boxes of the caps: a bulging cap can have inside points on its outer side.
  std::span<const Region> extra_regions() const override { return regions_; }

 private:
  struct CapTriangle {
    Vector from, to, apex;
  };
  struct Cap {
    std::vector<CapTriangle> triangles;
    Vector middle = {};
    double radius = 0;
    Vector dipole = {};  // area vector / (4 pi)
    double perimeter = 0;
  };
  // The caps' winding number at a point and a bound on its change within a distance.
  struct Field {
    double value = 0;
    double change = 0;
  };

  static Cap MakeCap(std::span<const GridPoint> vertices,
                     std::span<const TriangleMesh::Triangle> triangles);
  static Region BoxOf(const Cap& cap, const LatticeExtent& extent);
  static void AddNear(const Cap& cap, const Vector& p, double reach, Field& field);
  Field CapField(const Vector& p, double reach) const;
  void Decide(const LatticeRow& row, CellSpan segment, int winding,
              std::vector<CellSpan>& inside) const;

  std::vector<Cap> caps_;
  std::vector<Region> regions_;
  int sign_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_GENERALIZED_WINDING_H_
