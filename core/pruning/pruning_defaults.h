#ifndef BCCSKEL_CORE_PRUNING_PRUNING_DEFAULTS_H_
#define BCCSKEL_CORE_PRUNING_PRUNING_DEFAULTS_H_

#include "core/pruning/prune.h"

namespace bccskel {

// Returns the options with a threshold of 0 replaced by the rule's default; without a rule the
// threshold becomes 0.
PruningOptions WithDefaults(PruningOptions options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNING_DEFAULTS_H_
