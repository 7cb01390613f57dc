#ifndef BCCSKEL_CORE_PREPARE_CHANGED_VOLUME_H_
#define BCCSKEL_CORE_PREPARE_CHANGED_VOLUME_H_

#include <cstdint>

#include "core/volume/volume.h"

namespace bccskel {

// The result of one operation on an object.
struct ChangedVolume {
  Volume object;
  uint64_t count = 0;  // of the cavities or components that it changed
  uint64_t points_added = 0;
  uint64_t points_removed = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_CHANGED_VOLUME_H_
