#ifndef BCCSKEL_CLIENT_CLI_ROOT_ARGUMENT_H_
#define BCCSKEL_CLIENT_CLI_ROOT_ARGUMENT_H_

#include <optional>

#include "core/skeleton/tree_order.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds --root: where trees begin, and with it that they are ordered.
void AddRoot(CLI::App& command, std::optional<RootChoice>& root);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_ROOT_ARGUMENT_H_
