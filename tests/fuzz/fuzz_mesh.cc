// Any bytes as a mesh file: an error or a mesh whose indices hold, never a crash; and any mesh
// filled with a few points, of which keeping thin parts takes none away; open ones are refused.
// Slivers cross a hundred million rows per fill, so each fill has a deadline, which it must keep.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/import/mesh/mesh_file.h"
#include "core/import/voxelize/voxelize.h"

namespace {

using bccskel::ThinParts;
using bccskel::TriangleMesh;

auto FillWithin(const TriangleMesh& mesh, const bccskel::VoxelizeOptions& options) {
  bccskel::exec::Context context;
  context.deadline = bccskel::exec::Context::Clock::now() + std::chrono::milliseconds(500);
  return Voxelize(mesh, options, context);
}

void Fill(const TriangleMesh& mesh) {
  constexpr size_t kMostTriangles = 1000;
  if (mesh.triangles.size() > kMostTriangles) return;
  bccskel::VoxelizeOptions options = {.points = 300, .max_points = 100'000};
  const auto kept = FillWithin(mesh, options);
  if (!kept.ok()) return;
  const auto& spacing = kept->volume.placement().spacing;
  options.points.reset();
  options.spacing = spacing[0];
  options.topology = bccskel::TopologyCheck::kSkip;
  options.thin_parts = ThinParts::kSample;
  const auto sampled = FillWithin(mesh, options);
  options.thin_parts = ThinParts::kKeep;
  const auto whole = FillWithin(mesh, options);
  if (!sampled.ok() || !whole.ok()) return;
  if (whole->volume.PointCount() != sampled->volume.PointCount() + whole->added_points) {
    std::abort();
  }
  sampled->volume.ForEachPoint([&](bccskel::LatticePoint p) {
    if (!whole->volume.Contains(p)) std::abort();
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  // OBJ and STL as text have no mark of their own: there the name decides. Those of glTF, VTK and
  // GIFTI are in the seeds.
  for (const std::string_view name : {"fuzz.obj", "fuzz.stl"}) {
    const auto mesh = bccskel::ParseMesh(bytes, name);
    if (!mesh.ok()) continue;
    for (const auto& triangle : mesh->triangles) {
      for (const uint32_t corner : triangle) {
        if (corner >= mesh->vertices.size()) std::abort();
      }
    }
    Fill(*mesh);
  }
  return 0;
}
