#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/random.h"
#include "tests/quality/measure.h"
#include "tests/quality/sketch.h"
#include "tests/quality/studies.h"
#include "tests/quality/voxel_mask.h"
#include "tests/quality/wild_figures.h"

namespace bccskel::quality {
namespace {

constexpr std::array<std::pair<const char*, Border>, 3> kBorders = {
    {{"ends", Border::kEnds}, {"auto", Border::kAuto}, {"continues", Border::kContinues}}};

// A straight limb with an elliptic section, through the whole image. In voxels.
struct Limb {
  Vector through, way, thin, wide;  // the latter three of length 1
  double radius = 0, half_width = 0;

  bool Contains(const Vector& p) const {
    const double u = Dot(p - through, thin) / radius, v = Dot(p - through, wide) / half_width;
    return u * u + v * v <= 1;
  }
  double WayTo(const Vector& p) const {
    const Vector from = p - through;
    return Length(from - Dot(from, way) * way);
  }
};

// Where a face cuts a limb.
struct Cut {
  Vector middle;
  double radius = 0;
  bool counts = false;  // it is steep enough, and no other limb comes near its middle
};

// An image that limbs cross in all directions, so that many cross others just before its border.
class CrowdedImage {
 public:
  CrowdedImage(double radius, double width, shapes::Random& random) : edge_(kRadii * radius) {
    for (int n = 0; n < kLimbs; ++n) {
      Limb limb;
      limb.radius = radius * random.Between(0.8, 1.2);
      limb.half_width = width * limb.radius;
      const auto place = [&] { return random.Between(0, edge_ - 1); };
      limb.through = {place(), place(), place()};
      limb.way = Unit(random.InUnitBall());
      limb.thin = Unit(Cross(limb.way, random.InUnitBall()));
      limb.wide = Cross(limb.way, limb.thin);
      limbs_.push_back(limb);
    }
  }

  VoxelMask Mask() const {
    const auto edge = static_cast<int32_t>(edge_);
    VoxelMask mask(MaskGrid{edge, edge, edge, {}});
    for (int32_t z = 0; z < edge; ++z) {
      for (int32_t y = 0; y < edge; ++y) {
        for (int32_t x = 0; x < edge; ++x) {
          const Vector p = {1.0 * x, 1.0 * y, 1.0 * z};
          const auto holds = [&](const Limb& limb) { return limb.Contains(p); };
          if (std::ranges::any_of(limbs_, holds)) mask.Flip({x, y, z});
        }
      }
    }
    return mask;
  }

  std::vector<Cut> Cuts() const {
    std::vector<Cut> cuts;
    for (const Limb& limb : limbs_) {
      for (double Vector::*axis : kAxes) {
        for (const double face : {-0.5, std::floor(edge_) - 0.5}) {
          const double t = (face - limb.through.*axis) / limb.way.*axis;
          const Vector middle = limb.through + t * limb.way;
          if (IsInImage(middle, 0)) {
            cuts.push_back(
                {middle, limb.half_width, Counts(limb, middle, std::abs(limb.way.*axis))});
          }
        }
      }
    }
    return cuts;
  }

  bool IsAtBorder(const Vector& p) const { return !IsInImage(p, 2); }

 private:
  static constexpr std::array<double Vector::*, 3> kAxes = {&Vector::x, &Vector::y, &Vector::z};
  static constexpr double kRadii = 10;  // the edge of the image, in radii of the limbs
  static constexpr int kLimbs = 7;

  // At least so far from the border, except for rounding.
  bool IsInImage(const Vector& p, double margin) const {
    return std::ranges::all_of(kAxes, [&](double Vector::*axis) {
      const double low = -0.5 + margin, high = std::floor(edge_) - 0.5 - margin;
      return p.*axis >= low - 1e-6 && p.*axis <= high + 1e-6;
    });
  }
  // Within two axes; across the third it lies on a face.
  bool IsFarFromEdges(const Vector& p, double margin) const {
    return std::ranges::count_if(kAxes, [&](double Vector::*axis) {
             return p.*axis >= margin && p.*axis <= edge_ - margin;
           }) == 2;
  }
  bool Counts(const Limb& limb, const Vector& middle, double cosine) const {
    constexpr double kLeastCosine = 0.64;  // 50 degrees
    if (cosine < kLeastCosine || !IsFarFromEdges(middle, limb.half_width / cosine + 1))
      return false;
    return std::ranges::all_of(limbs_, [&](const Limb& other) {
      return &other == &limb || other.WayTo(middle) >= other.half_width + limb.radius;
    });
  }

  const double edge_;
  std::vector<Limb> limbs_;
};

absl::StatusOr<std::vector<Vector>> EndsOfMask(VoxelMask mask, Border border,
                                               SkeletonizeOptions options) {
  options.border = border;
  BCCSKEL_ASSIGN_OR_RETURN(const MaskObject object, Convert(mask, options));
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                           Skeletonize(object.volume, object.options, exec::Context()));
  std::vector<Vector> ends;
  for (const SkeletonNode& node : result.graph.nodes) {
    if (node.kind != NodeKind::kEnd) continue;
    const WorldPoint at = result.graph.PositionOf(node.at);
    ends.push_back({at[0], at[1], at[2]});
  }
  return ends;
}

struct Counts {
  int cuts = 0, found = 0;
  int at_border = 0, elsewhere = 0;  // ends there; of them, those of no limb
};

void Judge(const CrowdedImage& image, const std::vector<Vector>& ends, Counts& counts) {
  const std::vector<Cut> cuts = image.Cuts();
  const auto is_near = [](const Cut& cut, const Vector& end, double reach) {
    return Length(end - cut.middle) <= reach;
  };
  for (const Cut& cut : cuts) {
    if (!cut.counts) continue;
    ++counts.cuts;
    const auto reaches = [&](const Vector& end) {
      return is_near(cut, end, std::max(cut.radius, 2.0));
    };
    counts.found += std::ranges::any_of(ends, reaches) ? 1 : 0;
  }
  for (const Vector& end : ends) {
    if (!image.IsAtBorder(end)) continue;
    ++counts.at_border;
    const auto reaches = [&](const Cut& cut) { return is_near(cut, end, 2 * cut.radius + 2); };
    counts.elsewhere += std::ranges::any_of(cuts, reaches) ? 0 : 1;
  }
}

// What remains of a mask in the box of its voxels.
VoxelMask Cropped(const VoxelMask& mask) {
  Voxel low = {mask.grid().nx, mask.grid().ny, mask.grid().nz}, high = {0, 0, 0};
  mask.ForEachVoxel([&](const Voxel& v) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], v[axis]);
      high[axis] = std::max(high[axis], v[axis]);
    }
  });
  VoxelMask cropped(MaskGrid{high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1, {}});
  mask.ForEachVoxel([&](const Voxel& v) {
    cropped.Flip({v[0] - low[0], v[1] - low[1], v[2] - low[2]});
  });
  return cropped;
}

}  // namespace

absl::Status StudyImageFaces(const StudyOptions& options) {
  constexpr int kImages = 8;
  const bool is_judging = options.half != Half::kTune;
  for (const double width : {1.0, 2.0}) {
    for (const double radius : {2.0, 3.5, 6.0}) {
      std::array<Counts, kBorders.size()> counts = {};
      for (int n = 0; n < kImages * options.turns; ++n) {
        shapes::Random random(static_cast<uint64_t>(2 * n + (is_judging ? 1 : 0)));
        const CrowdedImage image(radius, width, random);
        for (size_t b = 0; b < kBorders.size(); ++b) {
          BCCSKEL_ASSIGN_OR_RETURN(const std::vector<Vector> ends,
                                   EndsOfMask(image.Mask(), kBorders[b].second, options.skeleton));
          Judge(image, ends, counts[b]);
        }
      }
      for (size_t b = 0; b < kBorders.size(); ++b) {
        const auto& [cuts, found, at_border, elsewhere] = counts[b];
        absl::PrintF(
            "{\"study\": \"image-faces\", \"what\": \"crossing limbs\", \"width\": %g, "
            "\"radius\": %g, \"border\": \"%s\", \"cuts\": %d, \"found\": %d, \"at_border\": %d, "
            "\"elsewhere\": %d}\n",
            width, radius, kBorders[b].first, cuts, found, at_border, elsewhere);
      }
    }
  }
  std::array<int, kBorders.size()> changed = {};
  int figures = 0;
  constexpr double kSize = 13;  // of the largest part, in voxels
  for (const WildFigure& figure : WildFigures()) {
    for (int turn = 0; turn < options.turns; ++turn) {
      shapes::Random random(static_cast<uint64_t>(100 * turn + (is_judging ? 50 : 0)));
      const Sketch sketch = figure.draw({random, kSize}, figure.values);
      if (!sketch.knows_ends || (figure.judge_only && !is_judging)) continue;
      const auto pose = static_cast<uint64_t>(turn);
      const VoxelMask mask = SampleOnVoxels(Moved(Turned(sketch, RandomFrame(pose)), 4, pose));
      BCCSKEL_ASSIGN_OR_RETURN(const auto wanted,
                               EndsOfMask(mask, Border::kEnds, options.skeleton));
      ++figures;
      for (size_t b = 0; b < kBorders.size(); ++b) {
        BCCSKEL_ASSIGN_OR_RETURN(const std::vector<Vector> ends,
                                 EndsOfMask(Cropped(mask), kBorders[b].second, options.skeleton));
        changed[b] += ends.size() == wanted.size() ? 0 : 1;
      }
    }
  }
  for (size_t b = 0; b < kBorders.size(); ++b) {
    absl::PrintF(
        "{\"study\": \"image-faces\", \"what\": \"tight crops\", \"border\": \"%s\", "
        "\"figures\": %d, \"changed\": %d}\n",
        kBorders[b].first, figures, changed[b]);
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
