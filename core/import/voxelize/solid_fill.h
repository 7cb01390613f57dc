#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_SOLID_FILL_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_SOLID_FILL_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/import/mesh/mesh_report.h"
#include "core/import/voxelize/fill_rule.h"
#include "core/import/voxelize/grid_fit.h"
#include "core/import/voxelize/row_fill.h"
#include "core/volume/volume.h"

namespace bccskel {

// A surface with the rule that fits it, ready to be filled on one grid after another.
class SolidFill {
 public:
  // Needs: kParity or kWinding, allowed for the surface by ChooseFillRule(); `surface` stays.
  SolidFill(const Surface& surface, FillRule rule, uint64_t max_points);

  FillRule rule() const { return rule_; }
  FillRequest RequestOn(const GridFit& fit) const;
  // Errors: as FillRows().
  absl::StatusOr<Volume> Fill(const FillRequest& request, const exec::Context& context) const;
  // Adds points to what Fill() made of the request, so that thin parts stay whole.
  // Errors: as WithThinParts().
  absl::StatusOr<Volume> KeepThinParts(Volume sampling, const FillRequest& request,
                                       const exec::Context& context) const;

 private:
  // Closes an open surface; the caps are taken out again by the generalized winding number.
  void AddCaps();

  const Surface& surface_;
  const FillRule rule_;
  const uint64_t max_points_;
  std::vector<TriangleMesh::Triangle> triangles_;  // of the surface, then of the caps
  std::vector<int8_t> signs_;                      // per triangle: +1, or -1 to turn it outward
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_SOLID_FILL_H_
