#ifndef BCCSKEL_PROTO_WIRE_VOLUME_ENCODING_H_
#define BCCSKEL_PROTO_WIRE_VOLUME_ENCODING_H_

#include <utility>

#include "bccskel/v1/volume.pb.h"
#include "core/io/volume_header.h"

namespace bccskel::wire {

inline constexpr std::pair<v1::VolumeEncoding, VolumeEncoding> kVolumeEncodings[] = {
    {v1::VOLUME_ENCODING_OPENEXR, VolumeEncoding::kOpenExr},
    {v1::VOLUME_ENCODING_RAW_PLANES, VolumeEncoding::kRawPlanes},
    {v1::VOLUME_ENCODING_BRICKS, VolumeEncoding::kBricks},
    {v1::VOLUME_ENCODING_CUBIC_MASK, VolumeEncoding::kCubicMask}};

v1::VolumeEncoding ToMessage(VolumeEncoding encoding);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_VOLUME_ENCODING_H_
