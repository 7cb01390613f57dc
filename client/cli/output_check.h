#ifndef BCCSKEL_CLIENT_CLI_OUTPUT_CHECK_H_
#define BCCSKEL_CLIENT_CLI_OUTPUT_CHECK_H_

#include "absl/status/status.h"
#include "client/cli/arguments.h"

namespace bccskel::cli {

// Whether the command's files can be written, asked before work of hours. Errors: as
// CheckWritable(), for the first that cannot.
absl::Status CheckOutputs(const Arguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_OUTPUT_CHECK_H_
