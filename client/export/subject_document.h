#ifndef BCCSKEL_CLIENT_EXPORT_SUBJECT_DOCUMENT_H_
#define BCCSKEL_CLIENT_EXPORT_SUBJECT_DOCUMENT_H_

#include "absl/status/statusor.h"
#include "client/export/world.h"
#include "client/view/result_document.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// The result as ParseResultDocument() reads it from JsonText(), but without the document's text and
// roots. Writing and reading the text of a large graph would take most of the time of a picture.
// Errors: INVALID_ARGUMENT for numbers that JSON cannot hold.
absl::StatusOr<view::ResultDocument> DocumentOf(const SkeletonizeResult& result,
                                                const World& world);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SUBJECT_DOCUMENT_H_
