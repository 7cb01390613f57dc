#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/export/subject.h"
#include "client/view/display_surface.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"

namespace bccskel::exporting {

inline constexpr int kSvgWidth = 1240, kSvgHeight = 860;  // pixels
// Limit for the object's surface.
inline constexpr size_t kMostSvgTriangles = 200'000;

struct SvgContent {
  const std::string& title;  // plain text
  const view::ResultDocument& result;
  const view::DisplaySurface& surface;           // empty: the skeleton alone
  std::optional<uint64_t> skeleton_points = {};  // unknown to the document
  exec::Context context = {};
};

// A self-contained SVG: the object as tinted glass in three views, its skeleton colored by radius
// within, and the certificate in words. Curves of very many points, which no viewer could open as
// lines, are part of the images.
// Errors: CANCELLED, DEADLINE_EXCEEDED; RESOURCE_EXHAUSTED.
absl::StatusOr<std::string> SvgText(const SvgContent& content);

// The same of a subject.
// Needs:  `result` is the subject's, as JSON has it.
// Errors: also those of MakeDisplaySurface().
absl::StatusOr<std::string> SvgText(const Subject& subject, const view::ResultDocument& result);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_
