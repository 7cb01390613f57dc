#ifndef BCCSKEL_CORE_PREPARE_CHANGED_VOLUME_H_
#define BCCSKEL_CORE_PREPARE_CHANGED_VOLUME_H_

#include <cstdint>

#include "core/volume/volume.h"

namespace bccskel {

// What one operation made of an object.
struct ChangedVolume {
  Volume object;
  uint64_t count = 0;  // of what it worked on: cavities or components
  uint64_t points_added = 0;
  uint64_t points_removed = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_CHANGED_VOLUME_H_
