#include "core/pruning/cut_faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/status_macros.h"
#include "core/pruning/cross_section.h"

namespace bccskel {
namespace {

constexpr double kLeastCut = 1.5;  // of a cut, in voxels: thinner limbs need no search
constexpr double kLeastSeed = 2;   // of a pixel in a cut, so that its neighbors are in it, too
constexpr double kFlattest = 2;    // radius of a circle as large, in the least half-width
constexpr double kRayReach = 4;    // of rays, in the depth of the pixel from which they start
// How deep sections must be about as large as the cut: in its radius, and least, in voxels.
constexpr double kDeep = 0.3;
constexpr double kLeastDeep = 2;
constexpr double kSections = 4;                               // about as many are looked at
constexpr double kCutChange = 0.25, kCutChangeMargin = 0.25;  // of the radius; share, and voxels
constexpr double kLeastWay = 1.2;    // straight into the limb, in the longest half-width
constexpr int kWays = 4;             // on either side of the normal, up to 45 degrees
constexpr double kLeastShare = 0.5;  // of cuts, in the object's part of a face
// Of a voxel on a face in its two lists, and of a pixel of the grid.
constexpr uint64_t kBytesPerVoxel = 16, kBytesPerPixel = 1;

struct Pixel {
  int32_t u, v;
};

struct PixelBox {
  Pixel low, high;

  // With a pixel of margin on every side.
  size_t Width() const { return static_cast<size_t>(high.u - low.u) + 3; }
  size_t Height() const { return static_cast<size_t>(high.v - low.v) + 3; }
};

// Needs: at least one pixel.
PixelBox BoxAround(const std::vector<Pixel>& pixels) {
  const auto [low_u, high_u] = std::ranges::minmax(pixels, {}, &Pixel::u);
  const auto [low_v, high_v] = std::ranges::minmax(pixels, {}, &Pixel::v);
  return {{low_u.u, low_v.v}, {high_u.u, high_v.v}};
}

std::array<int32_t, 3> ArrayOf(LatticePoint p) { return {p.x, p.y, p.z}; }

// The object's voxels on a face of the image, in a grid that holds their box. Their depth
// is the number of steps to others, 1 to 127.
class PixelGrid {
  static constexpr uint8_t kTaken = 128;

 public:
  // Needs: `box` is that around the pixels.
  PixelGrid(const std::vector<Pixel>& pixels, const PixelBox& box)
      : low_{box.low.u - 1, box.low.v - 1},
        width_(box.Width()),
        depths_(box.Width() * box.Height()) {
    for (const Pixel& p : pixels) depths_[At(p)] = kTaken - 1;
    // The least of the neighbors before, then of those behind, plus a step.
    const auto step = [&](size_t at, size_t beside, size_t across) {
      const int least = std::min(depths_[beside], depths_[across]) + 1;
      depths_[at] = static_cast<uint8_t>(std::min<int>(depths_[at], least));
    };
    for (size_t at = width_; at < depths_.size(); ++at) step(at, at - 1, at - width_);
    for (size_t at = depths_.size() - width_; at-- > 0;) step(at, at + 1, at + width_);
  }

  bool Has(const Pixel& p) const {
    const auto column = static_cast<size_t>(p.u - low_.u);  // large if it is negative
    const size_t at = static_cast<size_t>(p.v - low_.v) * width_ + column;
    return column < width_ && p.v >= low_.v && at < depths_.size() && depths_[at] != 0;
  }
  // 0 if it was taken or if there is none.
  int DepthAt(const Pixel& p) const {
    return Has(p) && depths_[At(p)] < kTaken ? depths_[At(p)] : 0;
  }

  // In their order where they are as deep.
  std::vector<Pixel> DeepestFirst(const std::vector<Pixel>& pixels) const {
    std::array<size_t, kTaken> places = {};  // of the next pixel of each depth
    for (const Pixel& p : pixels) ++places[depths_[At(p)] - 1u];
    size_t before = 0;
    for (size_t depth = kTaken; depth-- > 0;) {
      before += std::exchange(places[depth], before);
    }
    std::vector<Pixel> sorted(pixels.size());
    for (const Pixel& p : pixels) sorted[places[depths_[At(p)] - 1u]++] = p;
    return sorted;
  }

  // The pixels at most so far from the place along u and v, as in an ellipse.
  void Take(double at_u, double at_v, double reach_u, double reach_v) {
    const auto height = static_cast<int32_t>(depths_.size() / width_);
    const int32_t first_v = std::max(low_.v, static_cast<int32_t>(std::ceil(at_v - reach_v)));
    const int32_t last_v =
        std::min(low_.v + height - 1, static_cast<int32_t>(std::floor(at_v + reach_v)));
    for (int32_t v = first_v; v <= last_v; ++v) {
      const double off = (v - at_v) / reach_v;
      const double half = reach_u * std::sqrt(std::max(1 - off * off, 0.0));
      const int32_t first_u = std::max(low_.u, static_cast<int32_t>(std::ceil(at_u - half)));
      const int32_t last_u = std::min(low_.u + static_cast<int32_t>(width_) - 1,
                                      static_cast<int32_t>(std::floor(at_u + half)));
      for (int32_t u = first_u; u <= last_u; ++u) {
        if (Has({u, v})) depths_[At({u, v})] = kTaken;
      }
    }
  }

 private:
  size_t At(const Pixel& p) const {
    return static_cast<size_t>(p.v - low_.v) * width_ + static_cast<size_t>(p.u - low_.u);
  }

  Pixel low_;
  size_t width_;
  std::vector<uint8_t> depths_;
};

// A part of a layer of voxels, as seen from its middle. Lengths are in lattice units.
struct Section {
  double u = 0, v = 0;  // of its middle, in voxels
  double area = 0;
  double least = 0, most = 0;  // from the middle to the surface

  double Radius() const { return std::sqrt(area / std::numbers::pi); }
};

// The points of a brick in each of its layers across an axis.
std::vector<BrickBits> LayersAcross(size_t axis) {
  const auto in_brick = [axis](int bit) {
    return static_cast<size_t>(ArrayOf(PointOf(BrickCoordinates{}, bit))[axis] / 2);
  };
  std::vector<BrickBits> layers(std::max({kBrickX, kBrickY, kBrickZ}));
  for (int bit = 0; bit < kBrickPoints; ++bit) layers[in_brick(bit)].Set(bit);
  return layers;
}

// One face of an image, and the layers of voxels that follow it.
class Face {
 public:
  // Needs: `bricks` outlives this.
  Face(const LatticeBox& image, const AxisScale& scale, int32_t cells, size_t axis, bool last,
       NearbyBricks& bricks)
      : axis_(axis), cells_(cells), inward_(last ? -1 : 1), image_(image), bricks_(bricks) {
    const auto low = ArrayOf(image.low), high = ArrayOf(image.high);
    layers_ = LayersAcross(axis);
    first_ = last ? high[axis] - cells : low[axis] + cells;
    for (size_t n = 0; n < 3; ++n) {
      low_[n] = low[n] + cells;
      edge_[n] = 2 * cells * scale[n];
    }
  }

  // Whether cuts across limbs make at least half of the object's voxels on the face.
  // Errors: of the budget.
  absl::StatusOr<bool> CutsLimbs(const Volume& object, exec::MemoryBudget& memory,
                                 const exec::Context& context) {
    exec::MemoryShare share(memory);
    uint64_t most = 0;
    ForEachBrickOn(object, [&](BrickCoordinates, const BrickBits& bits) { most += bits.Count(); });
    BCCSKEL_RETURN_IF_ERROR(share.TakeFor(most, kBytesPerVoxel, "voxels on a face of the image"));
    std::vector<Pixel> pixels;
    pixels.reserve(most);
    ForEachBrickOn(object, [&](BrickCoordinates brick, const BrickBits& bits) {
      bits.ForEachSetBit([&](int bit) {
        if (const auto pixel = PixelOf(PointOf(brick, bit))) pixels.push_back(*pixel);
      });
    });
    if (pixels.empty()) return false;
    const PixelBox box = BoxAround(pixels);
    BCCSKEL_RETURN_IF_ERROR(
        share.TakeFor(box.Width() * box.Height(), kBytesPerPixel, "pixels of a face of the image"));
    PixelGrid grid(pixels, box);
    return AreMostlyCuts(pixels, grid, context);
  }

 private:
  // Visits the points of bricks in the layer of the middles of the face's voxels.
  template <typename Visit>
  void ForEachBrickOn(const Volume& object, Visit visit) const {
    constexpr std::array<int32_t, 3> kLengths = {kBrickX, kBrickY, kBrickZ};
    for (BrickIndex n = 0; n < object.brick_count(); ++n) {
      const BrickCoordinates brick = object.keys()[n].coordinates();
      const int32_t from = first_ - ArrayOf(PointOf(brick, 0))[axis_];
      if (from < 0 || from >= 2 * kLengths[axis_] || from % 2 != 0) continue;
      visit(brick, object.bricks()[n] & layers_[static_cast<size_t>(from / 2)]);
    }
  }

  // Takes the deepest pixels from the grid first.
  bool AreMostlyCuts(const std::vector<Pixel>& pixels, PixelGrid& grid,
                     const exec::Context& context) {
    grid_ = &grid;
    const std::vector<Pixel> sorted = grid.DeepestFirst(pixels);
    const double pixel = edge_[u_] * edge_[v_];
    const double wide = std::max(edge_[u_], edge_[v_]), narrow = std::min(edge_[u_], edge_[v_]);
    double missing = kLeastShare * pixel * static_cast<double>(pixels.size());
    for (size_t n = 0; n < pixels.size(); ++n) {
      const auto [u, v] = sorted[n];
      const double depth = grid.DepthAt(sorted[n]);
      if (missing > pixel * static_cast<double>(pixels.size() - n)) return false;
      if (depth == 0) continue;
      if (depth < kLeastSeed || context.ShouldStop()) return false;
      const double reach = (kRayReach * depth + 1) * wide;
      const auto cut = SectionAt({static_cast<double>(u), static_cast<double>(v)}, 0, reach);
      if (!cut.has_value()) {
        grid.Take(u, v, depth, depth);
        continue;
      }
      const bool is_new = grid.DepthAt(NearestTo(*cut)) > 0;
      const double taken = std::max(cut->Radius(), depth * narrow);
      grid.Take(cut->u, cut->v, taken / edge_[u_], taken / edge_[v_]);
      if (!is_new || !CutsLimb(*cut, reach + wide)) continue;
      missing -= cut->area;
      if (missing <= 0) return true;
    }
    return false;
  }

  // The voxel with its middle there; none: it is not one.
  std::optional<Pixel> PixelOf(LatticePoint p) const {
    const auto at = ArrayOf(p);
    const auto u = static_cast<uint32_t>(at[u_] - low_[u_]);
    const auto v = static_cast<uint32_t>(at[v_] - low_[v_]);
    const auto edge = static_cast<uint32_t>(2 * cells_);  // a power of two
    if (((u | v) & (edge - 1)) != 0) return std::nullopt;
    const int shift = std::countr_zero(edge);
    return Pixel{static_cast<int32_t>(u >> shift), static_cast<int32_t>(v >> shift)};
  }

  static int32_t Whole(double x) { return FloorOf(x + 0.5); }
  static Pixel NearestTo(const Section& section) { return {Whole(section.u), Whole(section.v)}; }

  // The voxel around a place, `deep` layers behind the face; all in voxels.
  bool Has(double u, double v, double deep) const {
    const Pixel pixel = {Whole(u), Whole(v)};
    const int32_t layer = Whole(deep);
    if (layer == 0) return grid_->Has(pixel);
    std::array<int32_t, 3> at;
    at[axis_] = first_ + inward_ * 2 * cells_ * layer;
    at[u_] = low_[u_] + 2 * cells_ * pixel.u;
    at[v_] = low_[v_] + 2 * cells_ * pixel.v;
    const LatticePoint p = {at[0], at[1], at[2]};
    return image_.Contains(p) && bricks_.Contains(p);
  }

  // How far the object extends along a way, in steps of half an edge, at most to `reach`.
  double WayOut(const std::array<double, 3>& from, const std::array<double, 3>& way,
                double reach) const {
    const double step = std::min({edge_[axis_], edge_[u_], edge_[v_]}) / 2;
    const double u = step / edge_[u_] * way[0], v = step / edge_[v_] * way[1];
    const double deep = step / edge_[axis_] * way[2];
    for (int n = 1; step * (n - 0.5) < reach; ++n) {
      if (!Has(from[0] + n * u, from[1] + n * v, from[2] + n * deep)) return step * (n - 0.5);
    }
    return reach;
  }

  // The middle moves to the centroid of what rays see, in three rounds. None if the object extends
  // to `reach`; in the first rounds, where the middle may lie on one side, to twice as far.
  std::optional<Section> SectionAt(std::array<double, 2> middle, double deep, double reach) const {
    constexpr int kRounds = 3;
    constexpr std::array<Coordinates, 2> kPlane = {{{1, 0, 0}, {0, 1, 0}}};
    Section section;
    for (int round = 1; round <= kRounds; ++round) {
      const double most = round < kRounds ? 2 * reach : reach;
      if (!Has(middle[0], middle[1], deep)) return std::nullopt;
      section = {middle[0], middle[1], 0, most, 0};
      RayLengths lengths;
      RayWays ways;
      for (size_t n = 0; n < kRays; ++n) {
        ways[n] = RayIn(kPlane, n);
        lengths[n] = WayOut({middle[0], middle[1], deep}, ways[n], most);
        if (lengths[n] >= most) return std::nullopt;
        section.least = std::min(section.least, lengths[n]);
        section.most = std::max(section.most, lengths[n]);
      }
      const RayPolygon seen = PolygonOf(ways, lengths);
      section.area = seen.area;
      section.u = middle[0] += seen.middle[0] / edge_[u_];
      section.v = middle[1] += seen.middle[1] / edge_[v_];
    }
    return section;
  }

  bool CutsLimb(const Section& cut, double reach) const {
    const double voxel = std::sqrt(edge_[u_] * edge_[v_]), radius = cut.Radius();
    if (radius < kLeastCut * voxel || radius > kFlattest * cut.least) return false;
    const double deep = std::max(kLeastDeep, std::ceil(kDeep * radius / edge_[axis_]));
    const double step = std::max(std::floor(deep / kSections), 1.0);  // voxels
    std::array<double, 2> middle = {cut.u, cut.v};
    for (double gone = step; gone <= deep; gone += step) {
      const auto section = SectionAt(middle, gone, reach);
      if (!section.has_value()) return false;
      if (std::abs(section->Radius() - radius) > kCutChange * radius + kCutChangeMargin * voxel) {
        return false;
      }
      middle = {section->u, section->v};
    }
    return LeadsInto({cut.u, cut.v, 0}, kLeastWay * cut.most);
  }

  bool LeadsInto(const std::array<double, 3>& from, double length) const {
    for (int off = 0; off <= kWays; ++off) {  // most lead straight in
      for (int u = -off; u <= off; ++u) {
        for (int v = -off; v <= off; ++v) {
          if (std::max(std::abs(u), std::abs(v)) < off) continue;
          const double out = std::sqrt(kWays * kWays + u * u + v * v);
          if (WayOut(from, {u / out, v / out, kWays / out}, length) >= length) {
            return true;
          }
        }
      }
    }
    return false;
  }

  const size_t axis_, u_ = (axis_ + 1) % 3, v_ = (axis_ + 2) % 3;
  const int32_t cells_, inward_;
  const LatticeBox image_;
  NearbyBricks& bricks_;
  const PixelGrid* grid_ = nullptr;  // of the face
  std::vector<BrickBits> layers_;    // of bricks, across the axis
  int32_t first_ = 0;                // the middles of the first voxels
  std::array<int32_t, 3> low_ = {};  // likewise, across
  std::array<double, 3> edge_ = {};  // of a voxel, lattice units
};

}  // namespace

absl::StatusOr<ImageFaces> FacesThatCutLimbs(const Volume& object, const LatticeBox& image,
                                             int32_t cells, exec::MemoryBudget& memory,
                                             const exec::Context& context) {
  const AxisScale scale = AxisScaleOf(object.placement());
  NearbyBricks bricks(object);
  ImageFaces that_cut = kNoFaces;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const size_t side : {0u, 1u}) {
      Face face(image, scale, cells, axis, side == 1, bricks);
      BCCSKEL_ASSIGN_OR_RETURN(that_cut[axis][side], face.CutsLimbs(object, memory, context));
    }
  }
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  return that_cut;
}

}  // namespace bccskel
