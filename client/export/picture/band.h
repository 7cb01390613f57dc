#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_BAND_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_BAND_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "client/export/picture/beads.h"
#include "core/export/surface/surface_mesh.h"

namespace bccskel::exporting {

using ViewNormal = std::array<float, 3>;  // to the right, up, to the viewer

// The skeleton's sheets. Vertices as in Geometry::glass.
struct SheetGeometry {
  SurfaceMesh mesh;
  std::vector<ViewNormal> normals;  // one per vertex, of either orientation
  std::vector<LinearColor> colors;  // one per vertex
};

inline constexpr LinearColor kGlassTint = {0.47f, 0.61f, 0.80f};

// The contents of all bands of a picture, in sample coordinates.
struct Geometry {
  SurfaceMesh glass;  // vertices: x to the right, y up from the top edge (negative), depth
  std::vector<ViewNormal> normals;  // one per vertex
  std::vector<LinearColor> tints;   // of the glass, one per triangle; empty: kGlassTint
  Beads beads;
  SheetGeometry sheets;
};

// The surface at a sample. `depth` is infinite if there is none.
struct Hit {
  float depth;
  ViewNormal normal;
  LinearColor color;
};

// The items of a list that reach into each band, in their order.
class ItemsOfBands {
 public:
  // `rows_of(n)`: the lowest and the highest row that item n reaches. Needs: band_rows > 0.
  template <typename RowsOf>
  ItemsOfBands(size_t count, size_t bands, int band_rows, RowsOf rows_of) : first_(bands + 2) {
    const auto band_at = [&](float row) {
      return static_cast<size_t>(std::clamp(std::floor(row / static_cast<float>(band_rows)), 0.0f,
                                            static_cast<float>(bands - 1)));
    };
    const auto for_each = [&](auto visit) {
      for (uint32_t n = 0; n < count; ++n) {
        const auto [low, high] = rows_of(n);
        for (size_t band = band_at(low); band <= band_at(high); ++band) visit(band, n);
      }
    };
    for_each([&](size_t band, uint32_t) { ++first_[band + 2]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    for_each([&](size_t band, uint32_t n) { items_[first_[band + 1]++] = n; });
  }

  std::span<const uint32_t> In(size_t band) const {
    return std::span(items_).subspan(first_[band], first_[band + 1] - first_[band]);
  }

 private:
  std::vector<size_t> first_;
  std::vector<uint32_t> items_;
};

// A few rows of samples: the nearest and the farthest glass and the nearest bead or sheet of each.
class Band {
 public:
  Band(int width, int top, int rows);

  // Of the glass triangles and beads, draw at least those that reach into the band, in their order.
  void DrawGlass(const Geometry& geometry, std::span<const uint32_t> triangles);
  void DrawBeads(const std::vector<Bead>& beads, std::span<const uint32_t> some);
  void DrawSheets(const SheetGeometry& sheets);

  // Needs: 0 <= x < width, 0 <= row < rows.
  Hit near_glass(int x, int row) const { return near_.At(Index(x, row)); }
  Hit far_glass(int x, int row) const { return far_.At(Index(x, row)); }
  Hit bead(int x, int row) const { return bead_.At(Index(x, row)); }

 private:
  // Depths are on their own: most of what is drawn is hidden, and reads nothing else.
  struct Hits {
    std::vector<float> depths;
    std::vector<std::pair<ViewNormal, LinearColor>> looks;

    Hit At(size_t n) const { return {depths[n], looks[n].first, looks[n].second}; }
    void Set(size_t n, const Hit& hit) {
      depths[n] = hit.depth;
      looks[n] = {hit.normal, hit.color};
    }
  };

  size_t Index(int x, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  template <typename Visit>
  void ForEachSample(const SurfaceMesh& mesh, const SurfaceTriangle& triangle, Visit visit) const;
  void DrawBead(const Bead& bead);

  int width_;
  int top_;
  int rows_;
  Hits near_;
  Hits far_;
  Hits bead_;
};

inline constexpr float kNothing = std::numeric_limits<float>::infinity();

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_BAND_H_
