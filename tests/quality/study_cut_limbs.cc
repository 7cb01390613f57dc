#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/random.h"
#include "tests/quality/sketch.h"
#include "tests/quality/studies.h"
#include "tests/quality/voxel_mask.h"

namespace bccskel::quality {
namespace {

// A straight limb with an elliptic section, which both faces of the image across z cut off. In
// voxels.
struct CutLimb {
  Vector through;     // the middle of the image
  Vector way;         // of length 1
  Vector thin, wide;  // directions of the axes of the section, of length 1
  double radius = 0, half_width = 0;
  MaskGrid grid;
};

// Twelve radii long.
CutLimb RandomLimb(double radius, double half_width, double slant, shapes::Random& random) {
  const double around = random.Between(0, 2 * std::numbers::pi);
  CutLimb limb;
  limb.radius = radius;
  limb.half_width = half_width;
  limb.way = {std::sin(slant) * std::cos(around), std::sin(slant) * std::sin(around),
              std::cos(slant)};
  limb.thin = Unit(Cross(limb.way, random.InUnitBall()));
  limb.wide = Cross(limb.way, limb.thin);
  const double height = std::ceil(12 * radius * std::cos(slant));
  const double room = 2 * half_width / std::cos(slant) + 6;
  const auto across = [&](double way) {
    return static_cast<int32_t>(std::ceil(height / limb.way.z * std::abs(way) + room));
  };
  limb.grid = {across(limb.way.x), across(limb.way.y), static_cast<int32_t>(height), {}};
  limb.through = {(limb.grid.nx - 1) / 2.0 + random.Between(-1, 1),
                  (limb.grid.ny - 1) / 2.0 + random.Between(-1, 1), (limb.grid.nz - 1) / 2.0};
  return limb;
}

VoxelMask MaskOf(const CutLimb& limb) {
  VoxelMask mask(limb.grid);
  for (int32_t z = 0; z < limb.grid.nz; ++z) {
    for (int32_t y = 0; y < limb.grid.ny; ++y) {
      for (int32_t x = 0; x < limb.grid.nx; ++x) {
        const Vector from = Vector{1.0 * x, 1.0 * y, 1.0 * z} - limb.through;
        const double thin = Dot(from, limb.thin) / limb.radius;
        const double wide = Dot(from, limb.wide) / limb.half_width;
        if (thin * thin + wide * wide <= 1) mask.Flip({x, y, z});
      }
    }
  }
  return mask;
}

struct CutRow {
  int limbs = 0;
  int wrong = 0;              // limbs without two ends
  std::vector<double> gaps;   // from the middles of cuts to the nearest ends, in radii
  std::vector<double> radii;  // of these ends, in radii
};

void Judge(const CutLimb& limb, const SkeletonGraph& graph, CutRow& row) {
  std::vector<SkeletonPoint> ends;
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind == NodeKind::kEnd) ends.push_back(node.at);
  }
  ++row.limbs;
  row.wrong += ends.size() == 2 ? 0 : 1;
  for (const double face : {-0.5, limb.grid.nz - 0.5}) {
    if (ends.empty()) continue;
    const Vector middle = limb.through + ((face - limb.through.z) / limb.way.z) * limb.way;
    const auto gap = [&](const SkeletonPoint& end) {
      const WorldPoint at = graph.PositionOf(end);
      return Length(Vector{at[0], at[1], at[2]} - middle);
    };
    const SkeletonPoint& nearest = *std::ranges::min_element(ends, {}, gap);
    row.gaps.push_back(gap(nearest) / limb.radius);
    row.radii.push_back(graph.RadiusOf(nearest) / limb.radius);
  }
}

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

absl::Status StudyCutLimbs(const StudyOptions& options) {
  constexpr int kLimbs = 10;
  for (const double width : {1.0, 2.0}) {
    for (const double radius : {1.5, 3.0, 6.0}) {
      for (const double degrees : {10, 30, 50, 65}) {
        shapes::Random random(static_cast<uint64_t>(1000 * width + 100 * radius + degrees));
        CutRow row;
        for (int n = 0; n < kLimbs * options.turns; ++n) {
          const double slant =
              std::clamp(degrees + random.Between(-10, 10), 0.0, 70.0) * std::numbers::pi / 180;
          const double own = radius * random.Between(0.8, 1.2);
          const CutLimb limb = RandomLimb(own, width * own, slant, random);
          VoxelMask mask = MaskOf(limb);
          BCCSKEL_ASSIGN_OR_RETURN(const MaskObject object, Convert(mask, options.skeleton));
          BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                                   Skeletonize(object.volume, object.options, exec::Context()));
          Judge(limb, result.graph, row);
        }
        const double largest = row.gaps.empty() ? 0 : std::ranges::max(row.gaps);
        absl::PrintF(
            "{\"study\": \"cut-limbs\", \"width\": %g, \"radius\": %g, \"degrees\": %g, "
            "\"limbs\": %d, \"wrong\": %d, \"gap\": %.4f, \"largest_gap\": %.4f, "
            "\"end_radius\": %.4f}\n",
            width, radius, degrees, row.limbs, row.wrong, MedianOf(row.gaps), largest,
            MedianOf(row.radii));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
