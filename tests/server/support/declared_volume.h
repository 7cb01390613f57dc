#ifndef BCCSKEL_TESTS_SERVER_SUPPORT_DECLARED_VOLUME_H_
#define BCCSKEL_TESTS_SERVER_SUPPORT_DECLARED_VOLUME_H_

#include <cstddef>
#include <string>
#include <vector>

#include "bccskel/v1/skeletonization_service.pb.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// A volume as a caller sends it.
struct DeclaredVolume {
  v1::VolumeDeclaration declaration;
  std::string bytes;
};

// Declares the truth, the number of bricks included.
DeclaredVolume Declare(const Volume& volume, VolumeEncoding encoding,
                       VolumeCompression compression = VolumeCompression::kNone);

// 20,000 points, 1 loop.
const Volume& SmallTorus();
const DeclaredVolume& SmallTorusPlanes();

v1::SkeletonizeRequest ConfigRequest(const DeclaredVolume& volume);
v1::SkeletonizeRequest ChunkRequest(size_t offset, const std::string& data);
v1::SkeletonizeRequest FinishRequest(const DeclaredVolume& volume);

// A whole, well-formed conversation: config, chunks, finish.
std::vector<v1::SkeletonizeRequest> RequestsFor(const DeclaredVolume& volume,
                                                size_t chunk_bytes = size_t{1} << 18);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_SUPPORT_DECLARED_VOLUME_H_
