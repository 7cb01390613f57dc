#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_BAND_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_BAND_H_

#include <cstdint>
#include <limits>
#include <span>
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
  std::vector<Bead> beads;
  SheetGeometry sheets;
};

// The surface at a sample. `depth` is infinite if there is none.
struct Hit {
  float depth;
  ViewNormal normal;
  LinearColor color;
};

// A few rows of samples: the nearest and the farthest glass and the nearest bead or sheet of each.
class Band {
 public:
  Band(int width, int top, int rows);

  void Draw(const Geometry& geometry);
  // The same with some of the geometry's beads: those that reach into the band, in their order.
  void Draw(const Geometry& geometry, std::span<const uint32_t> beads);

  // Needs: 0 <= x < width, 0 <= row < rows.
  const Hit& near_glass(int x, int row) const { return near_[Index(x, row)]; }
  const Hit& far_glass(int x, int row) const { return far_[Index(x, row)]; }
  const Hit& bead(int x, int row) const { return bead_[Index(x, row)]; }

 private:
  size_t Index(int x, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  template <typename Visit>
  void ForEachSample(const SurfaceMesh& mesh, const SurfaceTriangle& triangle, Visit visit) const;
  void DrawGlass(const Geometry& geometry, size_t triangle);
  void DrawSheet(const SheetGeometry& sheets, const SurfaceTriangle& triangle);
  void DrawBead(const Bead& bead);

  int width_;
  int top_;
  int rows_;
  std::vector<Hit> near_;
  std::vector<Hit> far_;
  std::vector<Hit> bead_;
};

inline constexpr float kNothing = std::numeric_limits<float>::infinity();

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_BAND_H_
