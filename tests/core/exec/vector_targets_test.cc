#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "hwy/highway.h"
#include "hwy/targets.h"

namespace bccskel::exec {
namespace {

// On processors for which Highway's own library is linked, this compares it with itself.
TEST(VectorTargets, AreThoseOfHighwayWithoutItsLibraryWhichTakesLongToLoad) {
#if HWY_ARCH_X86
  ASSERT_EQ(dlopen(BCCSKEL_HIGHWAY, RTLD_NOW | RTLD_NOLOAD), nullptr);
#endif
  void* library = dlopen(BCCSKEL_HIGHWAY, RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(library, nullptr) << dlerror();
  using Function = int64_t();
  auto* highway = reinterpret_cast<Function*>(dlsym(library, "_ZN3hwy16SupportedTargetsEv"));
  ASSERT_NE(highway, nullptr) << dlerror();
  EXPECT_EQ(hwy::SupportedTargets() & HWY_TARGETS, highway() & HWY_TARGETS);
}

}  // namespace
}  // namespace bccskel::exec
