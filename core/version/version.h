#ifndef BCCSKEL_CORE_VERSION_VERSION_H_
#define BCCSKEL_CORE_VERSION_VERSION_H_

#include <string_view>

namespace bccskel {

// The semantic version, "MAJOR.MINOR.PATCH". It is stated once, in the root CMakeLists.txt.
std::string_view Version() noexcept;

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VERSION_VERSION_H_
