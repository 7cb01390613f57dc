#ifndef BCCSKEL_CLIENT_EXPORT_SUBJECT_H_
#define BCCSKEL_CLIENT_EXPORT_SUBJECT_H_

#include <string>

#include "core/lattice/lattice_point.h"
#include "core/pipeline/skeletonize.h"
#include "core/volume/volume.h"

namespace bccskel::exporting {

// A skeleton and what it is the skeleton of: what the formats are made from. Whoever holds one
// keeps the two values alive.
struct Subject {
  const SkeletonizeResult& result;
  const Volume& object;
  std::string title;  // of pictures; plain text
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SUBJECT_H_
