#ifndef BCCSKEL_CLIENT_VOLUME_DECLARATION_H_
#define BCCSKEL_CLIENT_VOLUME_DECLARATION_H_

#include "bccskel/v1/volume.pb.h"
#include "client/encoded_volume.h"

namespace bccskel::client {

v1::VolumeDeclaration DeclarationOf(const EncodedVolume& volume);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_VOLUME_DECLARATION_H_
