#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PICTURE_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PICTURE_H_

#include <string>

#include "core/lattice/lattice_point.h"
#include "core/pipeline/skeletonize.h"
#include "core/volume/volume.h"

namespace bccskel::exporting {

// What a picture shows. The references outlive the call.
struct PictureSubject {
  const SkeletonizeResult& result;
  const Volume& object;
  std::string title;  // plain text
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PICTURE_H_
