#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/random.h"
#include "tests/quality/sketch.h"
#include "tests/quality/studies.h"
#include "tests/quality/voxel_mask.h"

namespace bccskel::quality {
namespace {

// A tube with round caps, sampled in slices `thickness` times as thick as voxels are wide.
struct Tube {
  Vector from;
  Vector to;
  double radius = 0;
  MaskGrid grid;
};

// Twelve radii long, anywhere between voxels.
Tube RandomTube(double thickness, double radius, shapes::Random& random) {
  const Vector way = 12 * radius * Unit(random.InUnitBall());
  Tube tube;
  tube.radius = radius;
  const double room = radius + 2 * thickness;
  tube.from = {std::max(-way.x, 0.0) + room + random.Between(0, 1),
               std::max(-way.y, 0.0) + room + random.Between(0, 1),
               std::max(-way.z, 0.0) + room + random.Between(0, thickness)};
  tube.to = tube.from + way;
  const auto voxels = [&](double from, double to, double edge) {
    return static_cast<int32_t>(std::ceil((std::max(from, to) + room) / edge));
  };
  tube.grid = {voxels(tube.from.x, tube.to.x, 1),
               voxels(tube.from.y, tube.to.y, 1),
               voxels(tube.from.z, tube.to.z, thickness),
               {.spacing = {1, 1, thickness}}};
  return tube;
}

VoxelMask MaskOf(const Tube& tube) {
  VoxelMask mask(tube.grid);
  const double thickness = tube.grid.placement.spacing[2];
  for (int32_t z = 0; z < tube.grid.nz; ++z) {
    for (int32_t y = 0; y < tube.grid.ny; ++y) {
      for (int32_t x = 0; x < tube.grid.nx; ++x) {
        const Vector at = {1.0 * x, 1.0 * y, thickness * z};
        if (DistanceToSegment(at, tube.from, tube.to) < tube.radius) mask.Flip({x, y, z});
      }
    }
  }
  return mask;
}

struct Row {
  int tubes = 0;
  int wrong = 0;             // tubes without two ends
  std::vector<double> gaps;  // from the centers of caps to the nearest ends, in slices
  int narrow = 0;            // of these ends: with less than half the tube's radius
  double off = 0;            // sum of how far curves leave the middle, in radii
};

void Judge(const Tube& tube, const SkeletonGraph& graph, Row& row) {
  const auto place = [&](const SkeletonPoint& p) {
    const WorldPoint at = graph.PositionOf(p);
    return Vector{at[0], at[1], at[2]};
  };
  std::vector<SkeletonPoint> ends;
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind == NodeKind::kEnd) ends.push_back(node.at);
  }
  ++row.tubes;
  row.wrong += ends.size() == 2 ? 0 : 1;
  for (const Vector& cap : {tube.from, tube.to}) {
    if (ends.empty()) continue;
    const auto nearest = std::ranges::min_element(
        ends, {}, [&](const SkeletonPoint& end) { return Length(place(end) - cap); });
    row.gaps.push_back(Length(place(*nearest) - cap) / tube.grid.placement.spacing[2]);
    row.narrow += graph.RadiusOf(*nearest) < tube.radius / 2 ? 1 : 0;
  }
  double farthest = 0;
  for (const SkeletonPoint& p : graph.points) {
    farthest = std::max(farthest, DistanceToSegment(place(p), tube.from, tube.to));
  }
  row.off += farthest / tube.radius;
}

}  // namespace

absl::Status StudyThickSlices(const StudyOptions& options) {
  constexpr int kTubes = 8;
  for (const double thickness : {1, 3, 5, 8}) {
    for (const double half_width : {1.2, 2.0, 3.0}) {
      shapes::Random random(static_cast<uint64_t>(100 * thickness + 10 * half_width));
      Row row;
      for (int n = 0; n < kTubes * options.turns; ++n) {
        const Tube tube = RandomTube(thickness, half_width * thickness, random);
        VoxelMask mask = MaskOf(tube);
        BCCSKEL_ASSIGN_OR_RETURN(const MaskObject object, Convert(mask, options.skeleton));
        BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                                 Skeletonize(object.volume, object.options, exec::Context()));
        Judge(tube, result.graph, row);
      }
      double sum = 0;
      for (const double gap : row.gaps) sum += gap;
      const auto count = static_cast<double>(row.gaps.size());
      absl::PrintF(
          "{\"study\": \"thick-slices\", \"thickness\": %g, \"half_width\": %g, "
          "\"tubes\": %d, \"wrong\": %d, \"gap\": %.4f, \"largest_gap\": %.4f, "
          "\"narrow\": %d, \"off\": %.4f}\n",
          thickness, half_width, row.tubes, row.wrong, count > 0 ? sum / count : 0,
          count > 0 ? std::ranges::max(row.gaps) : 0, row.narrow, row.off / row.tubes);
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
