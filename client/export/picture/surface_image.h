#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SURFACE_IMAGE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SURFACE_IMAGE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "client/export/picture/projection.h"

namespace bccskel::exporting {

// Eight bits each of red, green, blue and opacity (not premultiplied), row by row from the top.
struct RgbaImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<uint8_t> pixels;
};

// The object as tinted glass: faint where its surface faces the viewer, dark toward its outlines,
// so that the skeleton inside shows.
// Shapes: one image pixel is one panel unit of the projection.
// Units:  `point_radius` in panel units: half the distance at which neighbors must join.
RgbaImage RenderSurface(std::span<const PanelPoint> surface, double point_radius, uint32_t width,
                        uint32_t height);

// Of points that hide each other, as spheres of one radius, keeps the nearest. Seen along an axis,
// few points of a long object remain, each of which covers much of the picture.
std::vector<PanelPoint> NearestOfEachPlace(std::span<const PanelPoint> points);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SURFACE_IMAGE_H_
