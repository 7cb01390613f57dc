#include "tests/server/support/declared_volume.h"

#include "core/digest/sha256.h"
#include "core/import/shapes/shapes.h"
#include "core/io/volume_encoder.h"
#include "proto/wire/placement.h"
#include "proto/wire/volume_encoding.h"

namespace bccskel::test {

DeclaredVolume Declare(const Volume& volume, VolumeEncoding encoding,
                       VolumeCompression compression) {
  DeclaredVolume declared;
  declared.bytes = *EncodeVolume(volume, {.encoding = encoding, .compression = compression});
  v1::VolumeDeclaration& declaration = declared.declaration;
  declaration.set_encoding(wire::ToMessage(encoding));
  if (encoding == VolumeEncoding::kRawPlanes) {
    declaration.set_compression(compression == VolumeCompression::kZstd
                                    ? v1::VOLUME_COMPRESSION_ZSTD
                                    : v1::VOLUME_COMPRESSION_NONE);
    *declaration.mutable_placement() = wire::ToMessage(volume.placement());
  }
  *declaration.mutable_extent() = wire::ToMessage(volume.extent());
  declaration.set_size_bytes(declared.bytes.size());
  declaration.set_max_bricks(volume.brick_count());
  return declared;
}

const Volume& SmallTorus() {
  static const Volume torus = *GenerateShape(Shape::kTorus, {.points = 20'000});
  return torus;
}

const DeclaredVolume& SmallTorusPlanes() {
  static const DeclaredVolume planes = Declare(SmallTorus(), VolumeEncoding::kRawPlanes);
  return planes;
}

v1::SkeletonizeRequest ConfigRequest(const DeclaredVolume& volume) {
  v1::SkeletonizeRequest request;
  *request.mutable_config()->mutable_volume() = volume.declaration;
  return request;
}

v1::SkeletonizeRequest ChunkRequest(size_t offset, const std::string& data) {
  v1::SkeletonizeRequest request;
  request.mutable_chunk()->set_offset(offset);
  request.mutable_chunk()->set_data(data);
  return request;
}

v1::SkeletonizeRequest FinishRequest(const DeclaredVolume& volume) {
  const Sha256Digest digest = Sha256Of(volume.bytes);
  v1::SkeletonizeRequest request;
  request.mutable_finish()->set_size_bytes(volume.bytes.size());
  request.mutable_finish()->set_sha256(digest.bytes.data(), digest.bytes.size());
  return request;
}

std::vector<v1::SkeletonizeRequest> RequestsFor(const DeclaredVolume& volume, size_t chunk_bytes) {
  std::vector<v1::SkeletonizeRequest> requests = {ConfigRequest(volume)};
  for (size_t offset = 0; offset < volume.bytes.size(); offset += chunk_bytes) {
    requests.push_back(ChunkRequest(offset, volume.bytes.substr(offset, chunk_bytes)));
  }
  requests.push_back(FinishRequest(volume));
  return requests;
}

}  // namespace bccskel::test
