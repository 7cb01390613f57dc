#ifndef BCCSKEL_CLIENT_CLI_DETACH_H_
#define BCCSKEL_CLIENT_CLI_DETACH_H_

#include <stop_token>

#include "client/cli/arguments.h"
#include "client/cli/exit_code.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Sends the object, makes a job of it that the server keeps, and prints the job's name.
ExitCode SubmitDetached(const SkeletonizeArguments& arguments, const Volume& object,
                        const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_DETACH_H_
