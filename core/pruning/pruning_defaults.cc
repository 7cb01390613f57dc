#include "core/pruning/pruning_defaults.h"

namespace bccskel {
namespace {

constexpr double kDefaultRelativeLength = 1;
constexpr double kDefaultPersistence = 6;

double DefaultOf(PruningRule rule) {
  switch (rule) {
    case PruningRule::kSignificance:
      return kDefaultSignificance;
    case PruningRule::kRelativeLength:
      return kDefaultRelativeLength;
    case PruningRule::kPersistence:
      return kDefaultPersistence;
    case PruningRule::kLength:  // must be given
    case PruningRule::kNone:
      return 0;
  }
  return 0;
}

}  // namespace

PruningOptions WithDefaults(PruningOptions options) {
  if (options.threshold == 0 || options.rule == PruningRule::kNone) {
    options.threshold = DefaultOf(options.rule);
  }
  return options;
}

}  // namespace bccskel
