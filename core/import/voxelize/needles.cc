#include "core/import/voxelize/needles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/voxelize/gather.h"

namespace bccskel {
namespace {

constexpr double kFacesAway = -0.49;  // cosine of the two normals, at most
constexpr double kProbeStep = 2;      // lattice units
constexpr double kRayStep = 0.5;
constexpr double kInside = 0.25;  // of the height
constexpr double kCell = 2;       // lattice units
constexpr double kSlack = 0.25;   // of a box, lattice units: half a step along a ray
constexpr double kAlongRay = 0.5;
constexpr size_t kAtOnce = 256;  // triangles
constexpr double kMostProbes = 1 << 24;

// A triangle less than two units across its longest edge.
struct Slim {
  Coordinates start, edge;  // of the longest edge
  Coordinates to_corner;    // from `start` to the third corner
  Coordinates normal;
  double length = 0;           // of the longest edge
  double foot = 0;             // of the height on it, 0 to 1
  Coordinates height;          // from there to the third corner
  int probes = 1;              // evenly spaced along the longest edge
  int rays = 1;                // of each probe, evenly spaced, too
  std::vector<int> thin = {};  // the probes behind which the solid may be thin

  // The place across from this part of the longest edge, 0 to 1, a quarter of the way to the other
  // edges.
  Coordinates At(double along) const {
    const double rise = along < foot ? along / foot : (1 - along) / (1 - foot);
    return Sum(Sum(start, along, edge), kInside * rise, height);
  }
};

std::optional<Slim> SlimOf(const SurfaceSides& sides, uint32_t triangle) {
  const auto corners = sides.Corners(triangle);
  Slim slim{
      .start = {}, .edge = {}, .to_corner = {}, .normal = sides.Normal(triangle), .height = {}};
  for (size_t n = 0; n < corners.size(); ++n) {
    const Coordinates edge = Sum(corners[(n + 1) % 3], -1, corners[n]);
    const double length = LengthOf(edge);
    if (length <= slim.length) continue;
    slim.length = length;
    slim.start = corners[n], slim.edge = edge;
    slim.to_corner = Sum(corners[(n + 2) % 3], -1, corners[n]);
  }
  const Coordinates area = Cross(slim.edge, slim.to_corner);
  const double twice_area = LengthOf(area);
  if (twice_area == 0 || twice_area >= kLeastResolved * slim.length) return std::nullopt;
  slim.foot = std::clamp(Dot(slim.to_corner, slim.edge) / (slim.length * slim.length), 0.0, 1.0);
  slim.height = Sum(slim.to_corner, -slim.foot, slim.edge);
  slim.probes = static_cast<int>(slim.length / kProbeStep) + 1;
  slim.rays = static_cast<int>(slim.length / slim.probes / kRayStep) + 1;
  return slim;
}

absl::Status CheckWork(const SurfaceSides& sides, std::span<const uint32_t> thin) {
  double probes = 0;
  for (const uint32_t t : thin) {
    if (const std::optional<Slim> slim = SlimOf(sides, t)) probes += slim->probes;
  }
  if (probes <= kMostProbes) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      absl::StrFormat("thin triangles take about %.3g probes (limit %.3g): choose a larger spacing "
                      "or fewer points, or pass --thin-parts sample",
                      probes, kMostProbes));
}

// Cells of the lattice, kCell wide, by their coordinates; of very large lattices some that are far
// apart are the same. Needs: no coordinate below -1000.
uint64_t CellOf(const Coordinates& place) {
  uint64_t cell = 0;
  for (const double v : place) cell = cell << 21 | static_cast<uint64_t>(v / kCell + 1024);
  return cell;
}

// The slim triangles that may belong to thin parts. Where a needle begins, its body lies behind the
// probes, so those beside thin ones count, too.
std::vector<Slim> ThinSlims(const SurfaceSides& sides, std::span<const uint32_t> thin,
                            const Volume& sampling, const exec::Context& context) {
  return Gather<Slim>(thin.size(), kAtOnce, context, [&] {
    return [&, bricks = NearbyBricks(sampling)](size_t n, std::vector<Slim>& slims) mutable {
      std::optional<Slim> slim = SlimOf(sides, thin[n]);
      if (!slim.has_value()) return;
      for (int probe = 0; probe < slim->probes; ++probe) {
        const Coordinates at = slim->At((probe + 0.5) / slim->probes);
        if (!MayBeThinBehind(at, slim->normal, bricks)) continue;
        const int last = std::min(probe + 1, slim->probes - 1);
        for (int near = std::max(probe - 1, 0); near <= last; ++near) {
          if (slim->thin.empty() || near > slim->thin.back()) slim->thin.push_back(near);
        }
      }
      if (!slim->thin.empty()) slims.push_back(*std::move(slim));
    };
  });
}

// How far along the ray, whose direction has length 1, the triangle is; none if it passes by.
std::optional<double> HitOf(const Slim& slim, const Coordinates& from, const Coordinates& way) {
  const Coordinates p = Cross(way, slim.to_corner);
  const double determinant = Dot(slim.edge, p);
  if (determinant == 0) return std::nullopt;
  const Coordinates out = Sum(from, -1, slim.start);
  const double u = Dot(out, p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;
  const Coordinates q = Cross(out, slim.edge);
  const double v = Dot(way, q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;
  return Dot(slim.to_corner, q) / determinant;
}

// Slim triangles by the cells that their thin pieces may reach.
class SlimIndex {
 public:
  explicit SlimIndex(std::vector<Slim> slims) : slims_(std::move(slims)) {
    for (uint32_t n = 0; n < slims_.size(); ++n) Enter(n);
    std::ranges::sort(entries_);
  }

  std::span<const Slim> slims() const { return slims_; }

  // The middle between the place and where the ray from there leaves a thin part.
  std::optional<Coordinates> MiddleBehind(const Coordinates& place, uint32_t own) const {
    const Coordinates way = Sum({0, 0, 0}, -1, slims_[own].normal);
    double nearest = kLeastResolved;
    const Slim* behind = nullptr;
    uint64_t last = std::numeric_limits<uint64_t>::max();
    for (double t = 0; t <= kLeastResolved; t += kAlongRay) {
      const uint64_t cell = CellOf(Sum(place, t, way));
      if (cell == last) continue;
      last = cell;
      const auto begin = std::ranges::lower_bound(entries_, std::pair(cell, uint32_t{0}));
      for (auto entry = begin; entry != entries_.end() && entry->first == cell; ++entry) {
        if (entry->second == own) continue;
        const std::optional<double> hit = HitOf(slims_[entry->second], place, way);
        if (!hit.has_value() || *hit <= 0 || *hit >= nearest) continue;
        nearest = *hit;
        behind = &slims_[entry->second];
      }
    }
    if (behind == nullptr || nearest < kLeastThickness) return std::nullopt;
    if (Dot(behind->normal, slims_[own].normal) > kFacesAway) return std::nullopt;
    return Sum(place, nearest / 2, way);
  }

 private:
  // The piece around each probe has a box of its own.
  void Enter(uint32_t n) {
    const Slim& slim = slims_[n];
    for (const int probe : slim.thin) {
      const Coordinates begin = Sum(slim.start, 1.0 * probe / slim.probes, slim.edge);
      const Coordinates end = Sum(slim.start, 1.0 * (probe + 1) / slim.probes, slim.edge);
      EnterBox(n, {begin, end, Sum(begin, 1, slim.height), Sum(end, 1, slim.height)});
    }
  }

  void EnterBox(uint32_t n, const std::array<Coordinates, 4>& corners) {
    Coordinates low = corners[0], high = corners[0];
    for (const Coordinates& corner : corners) {
      for (size_t axis = 0; axis < low.size(); ++axis) {
        low[axis] = std::min(low[axis], corner[axis]);
        high[axis] = std::max(high[axis], corner[axis]);
      }
    }
    const auto first = [](double v) { return std::floor((v - kSlack) / kCell) * kCell; };
    for (double x = first(low[0]); x <= high[0] + kSlack; x += kCell) {
      for (double y = first(low[1]); y <= high[1] + kSlack; y += kCell) {
        for (double z = first(low[2]); z <= high[2] + kSlack; z += kCell) {
          entries_.emplace_back(CellOf({x, y, z}), n);
        }
      }
    }
  }

  std::vector<Slim> slims_;
  std::vector<std::pair<uint64_t, uint32_t>> entries_;  // cell and triangle, sorted
};

void AppendPoints(const SlimIndex& index, uint32_t n, std::vector<LatticePoint>& points) {
  const Slim& slim = index.slims()[n];
  for (const int probe : slim.thin) {
    for (int ray = 0; ray < slim.rays; ++ray) {
      const Coordinates at = slim.At((probe + (ray + 0.5) / slim.rays) / slim.probes);
      const std::optional<Coordinates> middle = index.MiddleBehind(at, n);
      if (middle.has_value()) points.push_back(PointNear(*middle, {1, 1, 1}));
    }
  }
}

}  // namespace

absl::StatusOr<std::vector<LatticePoint>> NeedlePoints(const SurfaceSides& sides,
                                                       std::span<const uint32_t> thin,
                                                       const Volume& sampling,
                                                       const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckWork(sides, thin));
  const SlimIndex index(ThinSlims(sides, thin, sampling, context));
  return Gather<LatticePoint>(index.slims().size(), kAtOnce, context, [&] {
    return [&](size_t n, std::vector<LatticePoint>& points) {
      AppendPoints(index, static_cast<uint32_t>(n), points);
    };
  });
}

}  // namespace bccskel
