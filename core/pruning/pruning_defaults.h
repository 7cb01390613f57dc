#ifndef BCCSKEL_CORE_PRUNING_PRUNING_DEFAULTS_H_
#define BCCSKEL_CORE_PRUNING_PRUNING_DEFAULTS_H_

#include "core/pruning/prune.h"

namespace bccskel {

// The same options with the rule's default in place of a threshold of 0, and of none for no rule.
PruningOptions WithDefaults(PruningOptions options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNING_DEFAULTS_H_
