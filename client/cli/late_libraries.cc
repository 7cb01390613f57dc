#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "client/cli/console.h"

// Resolves a function of `link_late` at its first call. Ends the program if the library is missing,
// as the dynamic linker would have done at the start.
extern "C" __attribute__((used)) void* bccskel_late_function(const char* library,
                                                             const char* name) {
  void* opened = dlopen(library, RTLD_NOW);
  void* function = opened != nullptr ? dlsym(opened, name) : nullptr;
  if (function == nullptr) {
    std::fprintf(stderr, "bccskel: error: %s\n", dlerror());
    std::_Exit(static_cast<int>(bccskel::cli::ExitCode::kInternal));
  }
  return function;
}
