#ifndef BCCSKEL_CLIENT_CLI_METHOD_WORDS_H_
#define BCCSKEL_CLIENT_CLI_METHOD_WORDS_H_

#include <string>
#include <utility>
#include <vector>

#include "core/thinning/thinning.h"

namespace bccskel::cli {

// The words of the command line for the methods.
inline std::vector<std::pair<std::string, ThinningMethod>> MethodWords() {
  return {{"directional", ThinningMethod::kDirectional},
          {"directional-alternating", ThinningMethod::kDirectionalAlternating},
          {"symmetric", ThinningMethod::kSymmetric}};
}

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_METHOD_WORDS_H_
