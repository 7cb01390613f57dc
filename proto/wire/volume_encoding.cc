#include "proto/wire/volume_encoding.h"

#include "proto/wire/enumerators.h"

namespace bccskel::wire {

v1::VolumeEncoding ToMessage(VolumeEncoding encoding) {
  return EnumeratorOf(encoding, kVolumeEncodings);
}

}  // namespace bccskel::wire
