#include "client/volume_declaration.h"

#include "proto/wire/placement.h"

namespace bccskel::client {
namespace {

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

}  // namespace

v1::VolumeDeclaration DeclarationOf(const EncodedVolume& volume) {
  v1::VolumeDeclaration declaration;
  declaration.set_encoding(ToMessage(volume.encoding));
  *declaration.mutable_extent() = wire::ToMessage(volume.extent);
  declaration.set_size_bytes(volume.bytes.size());
  declaration.set_max_bricks(volume.bricks);
  return declaration;
}

}  // namespace bccskel::client
