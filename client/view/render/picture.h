#ifndef BCCSKEL_CLIENT_VIEW_RENDER_PICTURE_H_
#define BCCSKEL_CLIENT_VIEW_RENDER_PICTURE_H_

#include <cstddef>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/view/display_surface.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"

namespace bccskel::view {

struct PictureOptions {
  int width = 1200;  // pixels
  int height = 900;
  // Degrees around the object to the right of its front, FrontOf(), and up; none: those of the
  // front.
  std::optional<double> turn;
  std::optional<double> climb;
  std::string title;  // omitted if it is not UTF-8
};

inline constexpr int kMinPictureSide = 160;
inline constexpr int kMaxPictureSide = 16384;
// Limit for the object's surface; fine enough for print.
inline constexpr size_t kMostPictureTriangles = 1'000'000;

// A PNG file: the object as tinted glass, its skeleton inside colored by radius, and a legend. With
// an empty surface the skeleton alone.
// Equal values give equal bytes for any number of threads, with the same fonts installed.
// Needs:  kMinPictureSide <= width, height <= kMaxPictureSide.
// Errors: CANCELLED, DEADLINE_EXCEEDED; RESOURCE_EXHAUSTED.
absl::StatusOr<std::string> RenderPng(const ResultDocument& result, const DisplaySurface& surface,
                                      const PictureOptions& options, const exec::Context& context);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RENDER_PICTURE_H_
