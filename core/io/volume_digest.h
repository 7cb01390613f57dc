#ifndef BCCSKEL_CORE_IO_VOLUME_DIGEST_H_
#define BCCSKEL_CORE_IO_VOLUME_DIGEST_H_

#include <string>

#include "core/volume/volume.h"

namespace bccskel {

// The name of a volume by its content: SHA-256, as 64 lower case hexadecimal digits, of its
// canonical bytes, which are the bricks encoding without compression (README.md). Extent, placement
// and occupied bricks decide; the encoding in which the volume came does not.
std::string VolumeDigest(const Volume& volume);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_DIGEST_H_
