#ifndef BCCSKEL_CLIENT_CLI_NAMED_OPTIONS_H_
#define BCCSKEL_CLIENT_CLI_NAMED_OPTIONS_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"

namespace bccskel::cli {

// An option of the command line as another language names and gives it: {"pruning_threshold", "1"}.
struct NamedOption {
  std::string name;
  std::optional<std::string> value;  // none: a flag that is set
};

enum class OptionSet { kMask, kMesh, kLabels, kFile };

// A message with the names of options as they are here: "--fill-cavities helps" becomes
// "fill_cavities helps".
std::string WithOptionNames(std::string_view message);

// The names that a set has, in the order of --help.
std::vector<std::string> OptionNames(OptionSet set);
// Whether an option is a flag. Needs: a name of the set.
bool IsFlag(OptionSet set, const std::string& name);

// What `skeletonize` makes of the options for a mask, a mesh or how a file is read: no input, no
// outputs. Errors: INVALID_ARGUMENT for values that are wrong or do not fit together; messages use
// the names
//         given here. NOT_FOUND for a name that the set has not.
absl::StatusOr<SkeletonizeArguments> ReadNamedOptions(OptionSet set,
                                                      const std::vector<NamedOption>& options);
// The same for `labels`.
absl::StatusOr<LabelsArguments> ReadLabelsOptions(const std::vector<NamedOption>& options);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_NAMED_OPTIONS_H_
