#ifndef BCCSKEL_CLIENT_VIEW_RENDER_SUBJECT_PICTURE_H_
#define BCCSKEL_CLIENT_VIEW_RENDER_SUBJECT_PICTURE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/subject.h"

namespace bccskel::view {

// RenderPng() with default options, for Subject::draw.
absl::StatusOr<std::string> DrawSubject(const exporting::Subject& subject);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RENDER_SUBJECT_PICTURE_H_
