#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/subject.h"

namespace bccskel::exporting {

// A self-contained SVG: the object as tinted glass in three views, its skeleton colored by radius
// within, and the certificate in words.
// Errors: RESOURCE_EXHAUSTED.
absl::StatusOr<std::string> SvgText(const Subject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_SVG_H_
