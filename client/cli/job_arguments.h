#ifndef BCCSKEL_CLIENT_CLI_JOB_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_JOB_ARGUMENTS_H_

#include <optional>

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// The commands for jobs that a server keeps, added to `app`.
class JobCommands {
 public:
  explicit JobCommands(CLI::App& app);
  // Nothing where the command line names none of them.
  std::optional<Arguments> Chosen() const;

 private:
  JobsArguments jobs_arguments_;
  WatchArguments watch_arguments_;
  CancelArguments cancel_arguments_;
  DeleteArguments delete_arguments_;
  FetchArguments fetch_arguments_;
  const CLI::App& jobs_;
  const CLI::App& watch_;
  const CLI::App& cancel_;
  const CLI::App& delete_;
  const CLI::App& fetch_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_JOB_ARGUMENTS_H_
