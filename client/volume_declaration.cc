#include "client/volume_declaration.h"

#include <algorithm>

#include "proto/wire/placement.h"
#include "proto/wire/volume_encoding.h"

namespace bccskel::client {

v1::VolumeDeclaration DeclarationOf(const EncodedVolume& volume) {
  v1::VolumeDeclaration declaration;
  declaration.set_encoding(wire::ToMessage(volume.encoding));
  *declaration.mutable_extent() = wire::ToMessage(volume.extent);
  declaration.set_size_bytes(volume.bytes.size());
  // 0 would mean unknown.
  declaration.set_max_bricks(std::max<uint64_t>(volume.bricks, 1));
  return declaration;
}

}  // namespace bccskel::client
