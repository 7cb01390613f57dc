#include "client/export/picture/glass_image.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/exec/status_macros.h"
#include "core/export/surface/smooth_surface.h"

namespace bccskel::exporting {
namespace {

constexpr int kBandRows = 16;  // pixels
constexpr LinearColor kPaperColor = {0.973f, 0.980f, 0.988f};

// Light on a surface from a lamp at the upper left in front of it.
struct Light {
  float diffuse;
  float gleam;   // the lamp's reflection
  float facing;  // 1 if the surface faces the viewer, 0 at outlines
};

Light LightOn(ViewNormal n, float sharpness) {
  constexpr ViewNormal kLamp = {-0.45f, 0.65f, 0.61f};
  const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const float sign = n[2] < 0 ? -1.0f : 1.0f;  // a far side is seen from inside
  if (length > 0) {
    for (float& part : n) part *= sign / length;
  }
  const float along = n[0] * kLamp[0] + n[1] * kLamp[1] + n[2] * kLamp[2];
  const float mirrored = std::max(0.0f, 2 * along * n[2] - kLamp[2]);
  return {std::max(0.0f, along), std::pow(mirrored, sharpness), n[2]};
}

void Cover(LinearColor& below, const LinearColor& above, float opacity) {
  const float part = std::clamp(opacity, 0.0f, 1.0f);
  for (size_t n = 0; n < 3; ++n) below[n] += part * (std::min(1.0f, above[n]) - below[n]);
}

// `body` is the opacity of glass that faces the viewer.
void CoverWithGlass(LinearColor& below, const Hit& glass, float body) {
  const Light light = LightOn(glass.normal, 30);
  const float rim = 1 - light.facing;
  LinearColor color;
  for (size_t n = 0; n < 3; ++n) {
    color[n] = glass.color[n] * (0.70f + 0.42f * light.diffuse - 0.22f * rim) + 0.28f * light.gleam;
  }
  Cover(below, color,
        body * (0.22f + 0.20f * (1 - light.diffuse)) + 0.80f * std::pow(rim, 1.7f) +
            0.18f * light.gleam);
}

LinearColor BeadColor(const Hit& bead) {
  const Light light = LightOn(bead.normal, 24);
  LinearColor shaded;
  for (size_t n = 0; n < 3; ++n) {
    shaded[n] = bead.color[n] * (0.55f + 0.5f * light.diffuse) + 0.35f * light.gleam;
  }
  return shaded;
}

// The color of a sample: the paper, the object's far side, the skeleton and the object's near side,
// composited in this order.
LinearColor ColorAt(const Band& band, int x, int row) {
  LinearColor color = kPaperColor;
  const Hit near = band.near_glass(x, row), bead = band.bead(x, row);
  if (bead.depth != -kNothing) {
    Cover(color, BeadColor(bead), 1);
  } else if (const Hit far = band.far_glass(x, row); far.depth < near.depth) {
    CoverWithGlass(color, far, 0.15f);
  }
  if (near.depth > bead.depth) CoverWithGlass(color, near, 0.8f);
  return color;
}

// The mean color of a pixel's samples.
uint32_t PixelAt(const Band& band, int x, int row, int samples) {
  LinearColor sum = {};
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const LinearColor color = ColorAt(band, samples * x + i, samples * row + j);
      for (size_t n = 0; n < 3; ++n) sum[n] += color[n];
    }
  }
  uint32_t pixel = 0xff;
  const auto count = static_cast<float>(samples * samples);
  for (const float part : sum) {
    pixel = pixel << 8 | static_cast<uint32_t>(std::lround(255 * part / count));
  }
  return pixel;
}

// What is in each band: large nets have millions of beads, too many for every band to look at.
struct Sorted {
  ItemsOfBands glass;
  std::vector<std::optional<ItemsOfBands>> beads;  // by part
};

absl::StatusOr<Sorted> SortIntoBands(const Geometry& geometry, size_t bands, int samples,
                                     const exec::Context& context) {
  const SurfaceMesh& glass = geometry.glass;
  const auto rows_of_triangle = [&](size_t n) {
    const auto& [a, b, c] = glass.triangles[n];
    return std::minmax({-glass.vertices[a][1], -glass.vertices[b][1], -glass.vertices[c][1]});
  };
  const int rows = kBandRows * samples;
  Sorted sorted = {ItemsOfBands(glass.triangles.size(), bands, rows, rows_of_triangle), {}};
  sorted.beads.resize(geometry.beads.size());
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(sorted.beads.size(), 1, [&](exec::Share share) {
    const std::vector<Bead>& part = geometry.beads[share.begin];
    sorted.beads[share.begin].emplace(part.size(), bands, rows, [&](size_t n) {
      return std::pair(part[n].y - part[n].radius, part[n].y + part[n].radius);
    });
  }));
  return sorted;
}

void DrawBand(const Geometry& geometry, const Sorted& sorted, size_t n, int samples,
              RgbImage& image) {
  const int top = kBandRows * static_cast<int>(n), rows = std::min(kBandRows, image.height - top);
  Band band(samples * image.width, samples * top, samples * rows);
  band.DrawGlass(geometry, sorted.glass.In(n));
  for (size_t part = 0; part < geometry.beads.size(); ++part) {
    band.DrawBeads(geometry.beads[part], sorted.beads[part]->In(n));
  }
  band.DrawSheets(geometry.sheets);
  auto pixel = image.pixels.begin() + static_cast<ptrdiff_t>(top) * image.width;
  for (int row = 0; row < rows; ++row) {
    for (int x = 0; x < image.width; ++x) *pixel++ = PixelAt(band, x, row, samples);
  }
}

}  // namespace

std::vector<SurfaceVertex> VerticesOf(const std::vector<WorldPoint>& points,
                                      const Projection& projection) {
  std::vector<SurfaceVertex> vertices;
  for (const WorldPoint& point : points) {
    const PanelPoint p = projection.Project(point);
    vertices.push_back(
        {static_cast<float>(p.x), static_cast<float>(-p.y), static_cast<float>(p.depth)});
  }
  return vertices;
}

Geometry GlassOf(const view::DisplaySurface& surface, const Projection& projection) {
  Geometry geometry;
  geometry.glass = {VerticesOf(surface.vertices, projection), surface.triangles};
  geometry.normals = NormalsOf(geometry.glass);
  constexpr double kLightness = 0.55;
  for (size_t n = 0; n < surface.triangles_of_labels.size(); ++n) {
    const LinearColor tint = LinearOf(LabelRgb(static_cast<uint32_t>(n), kLightness));
    geometry.tints.insert(geometry.tints.end(), surface.triangles_of_labels[n], tint);
  }
  return geometry;
}

absl::StatusOr<RgbImage> ImageOf(const Geometry& geometry, int width, int height, int samples,
                                 const exec::Context& context) {
  RgbImage image = {width, height, {}};
  image.pixels.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
  const auto bands = static_cast<size_t>((height + kBandRows - 1) / kBandRows);
  BCCSKEL_ASSIGN_OR_RETURN(const Sorted sorted, SortIntoBands(geometry, bands, samples, context));
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(bands, 1, [&](exec::Share share) {
    DrawBand(geometry, sorted, share.begin, samples, image);
  }));
  return image;
}

absl::StatusOr<std::string> PngOf(const RgbImage& image) {
  std::vector<uint8_t> rgb;
  rgb.reserve(3 * image.pixels.size());
  for (const uint32_t pixel : image.pixels) {
    for (const int shift : {16, 8, 0}) rgb.push_back(static_cast<uint8_t>(pixel >> shift));
  }
  png_image head = {};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<uint32_t>(image.width);
  head.height = static_cast<uint32_t>(image.height);
  head.format = PNG_FORMAT_RGB;
  std::string png(PNG_IMAGE_PNG_SIZE_MAX(head), '\0');
  png_alloc_size_t size = png.size();
  if (png_image_write_to_memory(&head, png.data(), &size, 0, rgb.data(), 0, nullptr) == 0) {
    return absl::ResourceExhaustedError(head.message);
  }
  png.resize(size);
  return png;
}

}  // namespace bccskel::exporting
