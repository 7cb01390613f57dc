#ifndef BCCSKEL_CLIENT_CLI_EXIT_CODE_H_
#define BCCSKEL_CLIENT_CLI_EXIT_CODE_H_

#include "absl/status/status.h"

namespace bccskel::cli {

// How the command line ends; part of its public contract (see bccskel.1 and --help).
enum class ExitCode : int {
  kOk = 0,
  kUsage = 2,        // the command line itself is wrong
  kBadInput = 3,     // the input cannot be read, or is not what it should be
  kUnavailable = 4,  // no server, or the server went away
  kStopped = 5,      // the deadline passed, or the server cancelled the job
  kInternal = 6,     // a defect: topology was not kept, a reply is damaged, a job crashes servers
  kTooLarge = 7,     // over a limit of the server or of this machine
  kOutput = 8,       // an output file cannot be written
  kCredentials = 9,  // a token is missing, wrong, or not one for this
  kInterrupted = 130,
  kTerminated = 143,
};

// The exit code for an error of the input or of a job.
ExitCode ExitCodeOf(const absl::Status& status);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_EXIT_CODE_H_
