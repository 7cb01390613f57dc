#ifndef BCCSKEL_CLIENT_CLI_OPTION_COMPLAINTS_H_
#define BCCSKEL_CLIENT_CLI_OPTION_COMPLAINTS_H_

#include <optional>
#include <string>

#include "core/pipeline/skeletonize.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::cli {

// What is wrong with options of a skeleton that are right one by one; nothing where they fit.
std::optional<std::string> ComplaintAboutOptions(const SkeletonizeOptions& options);

// The same for where the trees of many skeletons begin.
std::optional<std::string> ComplaintAboutRootOfLabels(const std::optional<RootChoice>& root);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_OPTION_COMPLAINTS_H_
