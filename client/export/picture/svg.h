#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/subject.h"
#include "client/view/result_document.h"

namespace bccskel::exporting {

// A self-contained SVG: the object as tinted glass in three views, its skeleton colored by radius
// within, and the certificate in words.
// Needs:  `result` is the subject's, as JSON has it.
// Errors: those of MakeDisplaySurface(); RESOURCE_EXHAUSTED.
absl::StatusOr<std::string> SvgText(const Subject& subject, const view::ResultDocument& result);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_
