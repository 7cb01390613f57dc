#include "core/import/voxelize/slab_plan.h"

#include <algorithm>

namespace bccskel {
namespace {

constexpr int kMaxSlabs = 256;

}  // namespace

SlabPlan::SlabPlan(const FillRequest& request) {
  const int layers = (request.extent.nz + kBrickZ - 1) / kBrickZ;
  const size_t most = 8 * request.triangles.size() + (1 << 20);
  std::vector<Slab> layers_of;  // by triangle
  layers_of.reserve(request.triangles.size());
  for (size_t t = 0; t < request.triangles.size(); ++t) {
    layers_of.push_back(LayersOf(request, t));
  }
  int slabs = std::min(layers, kMaxSlabs);
  while (slabs > 1 && CountVisits(layers_of, layers, slabs) > most) slabs /= 2;
  Assign(layers_of, layers, slabs);
}

void SlabPlan::SetSlabs(int layers, int slabs) {
  thickness_ = (layers + slabs - 1) / slabs;
  slabs_.clear();
  for (int bz = 0; bz < layers; bz += thickness_) {
    slabs_.push_back({bz, std::min(bz + thickness_, layers)});
  }
}

template <typename Visit>
void SlabPlan::ForEachSlabIn(Slab layers, Visit visit) const {
  const int last = std::min((layers.end_bz - 1) / thickness_, static_cast<int>(size()) - 1);
  for (int n = layers.begin_bz / thickness_; n <= last; ++n) visit(static_cast<size_t>(n));
}

size_t SlabPlan::CountVisits(std::span<const Slab> layers_of, int layers, int slabs) {
  SetSlabs(layers, slabs);
  size_t visits = 0;
  for (Slab reached : layers_of) ForEachSlabIn(reached, [&](size_t) { ++visits; });
  return visits;
}

void SlabPlan::Assign(std::span<const Slab> layers_of, int layers, int slabs) {
  SetSlabs(layers, slabs);
  begin_.assign(size() + 1, 0);
  for (Slab reached : layers_of) ForEachSlabIn(reached, [&](size_t n) { ++begin_[n + 1]; });
  for (size_t n = 0; n < size(); ++n) begin_[n + 1] += begin_[n];
  triangles_.resize(begin_.back());
  std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
  for (size_t t = 0; t < layers_of.size(); ++t) {
    ForEachSlabIn(layers_of[t],
                  [&](size_t n) { triangles_[next[n]++] = static_cast<uint32_t>(t); });
  }
}

}  // namespace bccskel
