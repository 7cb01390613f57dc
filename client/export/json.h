#ifndef BCCSKEL_CLIENT_EXPORT_JSON_H_
#define BCCSKEL_CLIENT_EXPORT_JSON_H_

#include <string>

#include "core/pipeline/skeletonize.h"

namespace bccskel::exporting {

// The JSON document of client/export/skeleton.schema.json: nodes, edges, certificate,
// object_points, timings, sha256. World coordinates and units.
std::string JsonText(const SkeletonizeResult& result);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_JSON_H_
