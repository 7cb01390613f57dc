#include "client/view/label_surfaces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <numeric>
#include <optional>

#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

constexpr double kFewTriangles = 24;

std::vector<size_t> SharesOf(const std::vector<uint64_t>& sizes, size_t most_triangles) {
  std::vector<double> areas;
  for (const uint64_t size : sizes) areas.push_back(std::pow(static_cast<double>(size), 2.0 / 3));
  const double all = std::max(std::accumulate(areas.begin(), areas.end(), 0.0), 1.0);
  std::vector<size_t> shares;
  for (const double area : areas) {
    const double share = static_cast<double>(most_triangles) * area / all;
    shares.push_back(static_cast<size_t>(std::max(share, kFewTriangles)));
  }
  return shares;
}

// Workers must not throw.
absl::StatusOr<DisplaySurface> SurfaceOfLabel(const ObjectOfLabel& object, size_t n,
                                              size_t most_triangles, const exec::Context& context) {
  try {
    BCCSKEL_ASSIGN_OR_RETURN(const std::shared_ptr<const Volume> volume, object(n));
    return MakeDisplaySurface(*volume, most_triangles, context);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory for the surfaces of the labels");
  }
}

void Append(const DisplaySurface& from, DisplaySurface& to) {
  const auto first = static_cast<uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const SurfaceTriangle& t : from.triangles) {
    to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  to.triangles_of_labels.push_back(from.triangles.size());
}

}  // namespace

absl::StatusOr<DisplaySurface> SurfacesOfLabels(const std::vector<uint64_t>& sizes,
                                                const ObjectOfLabel& object, size_t most_triangles,
                                                const exec::Context& context) {
  const std::vector<size_t> shares = SharesOf(sizes, most_triangles);
  std::vector<std::optional<absl::StatusOr<DisplaySurface>>> surfaces(sizes.size());
  exec::Context alone = context;
  alone.team = nullptr;
  std::atomic<size_t> next = 0;
  std::atomic<bool> failed = false;
  context.Offer([&](int) {
    for (size_t n; !failed && !context.ShouldStop() && (n = next++) < sizes.size();) {
      surfaces[n] = SurfaceOfLabel(object, n, shares[n], alone);
      if (!surfaces[n]->ok()) failed = true;
    }
  });
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  for (const auto& surface : surfaces) {
    if (surface.has_value()) BCCSKEL_RETURN_IF_ERROR(surface->status());
  }
  DisplaySurface all;
  for (auto& surface : surfaces) {
    Append(**surface, all);
    surface.reset();
  }
  return all;
}

}  // namespace bccskel::view
