#include "proto/wire/volume_encoding.h"

namespace bccskel::wire {

v1::VolumeEncoding ToMessage(VolumeEncoding encoding) {
  switch (encoding) {
    case VolumeEncoding::kOpenExr:
      return v1::VOLUME_ENCODING_OPENEXR;
    case VolumeEncoding::kRawPlanes:
      return v1::VOLUME_ENCODING_RAW_PLANES;
    case VolumeEncoding::kBricks:
      return v1::VOLUME_ENCODING_BRICKS;
    case VolumeEncoding::kCubicMask:
      return v1::VOLUME_ENCODING_CUBIC_MASK;
  }
  return v1::VOLUME_ENCODING_UNSPECIFIED;  // not reached: the enumerators are exhausted above
}

}  // namespace bccskel::wire
