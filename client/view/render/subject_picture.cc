#include "client/view/render/subject_picture.h"

#include "client/export/subject_document.h"
#include "client/view/display_surface.h"
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

}  // namespace bccskel::view
