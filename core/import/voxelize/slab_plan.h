#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_SLAB_PLAN_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_SLAB_PLAN_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/import/voxelize/row_crossings.h"
#include "core/import/voxelize/row_fill.h"

namespace bccskel {

// Divides the grid of a request into slabs of brick layers, at most 256, and lists the triangles
// that reach each of them. Slabs are independent of each other, so workers can share them.
class SlabPlan {
 public:
  explicit SlabPlan(const FillRequest& request);

  size_t size() const { return slabs_.size(); }
  Slab slab(size_t n) const { return slabs_[n]; }
  std::span<const uint32_t> triangles(size_t n) const {
    return std::span(triangles_).subspan(begin_[n], begin_[n + 1] - begin_[n]);
  }

 private:
  void SetSlabs(int layers, int slabs);
  template <typename Visit>
  void ForEachSlabIn(Slab layers, Visit visit) const;
  size_t CountVisits(std::span<const Slab> layers_of, int layers, int slabs);
  void Assign(std::span<const Slab> layers_of, int layers, int slabs);

  int thickness_ = 1;
  std::vector<Slab> slabs_;
  std::vector<size_t> begin_;
  std::vector<uint32_t> triangles_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_SLAB_PLAN_H_
