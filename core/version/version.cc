#include "core/version/version.h"

namespace bccskel {

std::string_view Version() noexcept { return BCCSKEL_VERSION; }

}  // namespace bccskel
