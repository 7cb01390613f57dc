#ifndef BCCSKEL_CLIENT_CLI_OBJECT_FIT_H_
#define BCCSKEL_CLIENT_CLI_OBJECT_FIT_H_

#include "absl/status/status.h"
#include "client/view/result_document.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Whether a result can be that of an object, in this or another grid: its balls lie in the object's
// box, and the object that it was made from has about the same volume.
// Errors: INVALID_ARGUMENT with what does not match.
absl::Status CheckObjectFits(const view::ResultDocument& result, const Volume& object);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_OBJECT_FIT_H_
