#ifndef BCCSKEL_CLIENT_VIEW_RENDER_SUBJECT_PICTURE_H_
#define BCCSKEL_CLIENT_VIEW_RENDER_SUBJECT_PICTURE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/skeleton_file.h"
#include "client/export/subject.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"

namespace bccskel::view {

// RenderPng() with default options, for Subject::draw.
absl::StatusOr<std::string> DrawSubject(const exporting::Subject& subject);

// A stored result without its object: the document itself, or a picture or a page of its curves.
// Needs: JSON, or a format that ShowsObject().
absl::StatusOr<std::string> ComposeDocument(exporting::SkeletonFormat format,
                                            const std::string& title, const ResultDocument& result,
                                            const exec::Context& context);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RENDER_SUBJECT_PICTURE_H_
