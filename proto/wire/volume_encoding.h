#ifndef BCCSKEL_PROTO_WIRE_VOLUME_ENCODING_H_
#define BCCSKEL_PROTO_WIRE_VOLUME_ENCODING_H_

#include "bccskel/v1/volume.pb.h"
#include "core/io/volume_header.h"

namespace bccskel::wire {

v1::VolumeEncoding ToMessage(VolumeEncoding encoding);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_VOLUME_ENCODING_H_
