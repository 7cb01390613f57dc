#include "core/io/volume_digest.h"

#include "core/digest/sha256.h"
#include "core/io/bricks_header.h"

namespace bccskel {

std::string VolumeDigest(const Volume& volume) {
  Sha256 sha;
  sha.Add(EncodeBricksHeader(volume, VolumeCompression::kNone));
  for (size_t n = 0; n < volume.brick_count(); ++n) {
    sha.Add(EncodeBrickRecord(volume.keys()[n], volume.bricks()[n]));
  }
  return sha.Finish().Hex();
}

}  // namespace bccskel
