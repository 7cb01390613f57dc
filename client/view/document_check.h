#ifndef BCCSKEL_CLIENT_VIEW_DOCUMENT_CHECK_H_
#define BCCSKEL_CLIENT_VIEW_DOCUMENT_CHECK_H_

#include "absl/status/status.h"
#include "client/view/result_document.h"

namespace bccskel::view {

// Whether the values of a document fit together: nodes that are named exist, no radius is negative.
// Errors: INVALID_ARGUMENT, names the place.
absl::Status CheckDocument(const ResultDocument& document);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_DOCUMENT_CHECK_H_
