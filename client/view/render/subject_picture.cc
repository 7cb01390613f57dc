#include "client/view/render/subject_picture.h"

#include "client/export/picture/svg.h"
#include "client/export/subject_document.h"
#include "client/view/display_surface.h"
#include "client/view/page.h"
#include "client/view/render/picture.h"
#include "client/view/result_document.h"
#include "core/exec/status_macros.h"

namespace bccskel::view {

absl::StatusOr<std::string> DrawSubject(const exporting::Subject& subject) {
  BCCSKEL_ASSIGN_OR_RETURN(const ResultDocument result, exporting::DocumentOf(subject));
  BCCSKEL_ASSIGN_OR_RETURN(const DisplaySurface surface,
                           exporting::SurfaceOf(subject, kMostPictureTriangles));
  PictureOptions options;
  options.title = subject.title;
  return RenderPng(result, surface, options, subject.context);
}

absl::StatusOr<std::string> ComposeDocument(exporting::SkeletonFormat format,
                                            const std::string& title, const ResultDocument& result,
                                            const exec::Context& context) {
  using exporting::SkeletonFormat;
  const DisplaySurface no_object;
  if (format == SkeletonFormat::kJson) return *result.text;
  if (format == SkeletonFormat::kHtml) return PageOf({title, result, Peeling()}, context);
  if (format == SkeletonFormat::kSvg) {
    return exporting::SvgText(
        {.title = title, .result = result, .surface = no_object, .context = context});
  }
  PictureOptions options;
  options.title = title;
  return RenderPng(result, no_object, options, context);
}

}  // namespace bccskel::view
