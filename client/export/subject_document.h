#ifndef BCCSKEL_CLIENT_EXPORT_SUBJECT_DOCUMENT_H_
#define BCCSKEL_CLIENT_EXPORT_SUBJECT_DOCUMENT_H_

#include "absl/status/statusor.h"
#include "client/export/subject.h"
#include "client/view/result_document.h"

namespace bccskel::exporting {

// The subject's result as ParseResultDocument() reads it from JsonText(), but without the
// document's text and roots, and with its labels. Writing and reading the text of a large graph
// would take most of the time of a picture. Errors: INVALID_ARGUMENT for numbers that JSON cannot
// hold; those of the context.
absl::StatusOr<view::ResultDocument> DocumentOf(const Subject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SUBJECT_DOCUMENT_H_
