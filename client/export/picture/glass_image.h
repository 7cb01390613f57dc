#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_GLASS_IMAGE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_GLASS_IMAGE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/export/picture/band.h"
#include "client/export/picture/projection.h"
#include "client/view/display_surface.h"
#include "core/exec/context.h"

namespace bccskel::exporting {

// Pixels 0xffrrggbb, row by row from the top.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<uint32_t> pixels;
};

// World points as vertices of a Geometry. Units: the projection's are samples.
std::vector<SurfaceVertex> VerticesOf(const std::vector<WorldPoint>& points,
                                      const Projection& projection);

// The object alone, as glass.
Geometry GlassOf(const view::DisplaySurface& surface, const Projection& projection);

// A pixel is the mean of `samples` samples, the units of a geometry, along each of its axes. Equal
// values give equal pixels for any number of threads.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<RgbImage> ImageOf(const Geometry& geometry, int width, int height, int samples,
                                 const exec::Context& context);

// The image as a PNG file. Errors: RESOURCE_EXHAUSTED when the encoder gets no memory.
absl::StatusOr<std::string> PngOf(const RgbImage& image);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_GLASS_IMAGE_H_
