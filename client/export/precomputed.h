#ifndef BCCSKEL_CLIENT_EXPORT_PRECOMPUTED_H_
#define BCCSKEL_CLIENT_EXPORT_PRECOMPUTED_H_

#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
#include "client/export/sampled_curve.h"
#include "client/export/world.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

struct PrecomputedOptions {
  GraphLabels labels = {};  // one segment each; without labels the only segment is 1
  World world = {};
  CurveSampling sampling = {};
};

// Neuroglancer's precomputed skeletons, unsharded: FOLDER/info, and for each segment FOLDER/ID with
// its nodes, then the points of its smooth curves, the edges between them, and the attribute
// radius. Coordinates and radii in nanometers, float32, little-endian; loops stay. Creates the
// folder if missing; keeps files of other segments.
// Returns what the format could not hold, as a sentence for the user; empty if it held everything.
// Errors: ALREADY_EXISTS if info describes anything but such skeletons; INVALID_ARGUMENT
//         (coordinates too large for a float32); those of WriteFileAtomically().
absl::StatusOr<std::string> WritePrecomputed(const std::string& folder, const SkeletonGraph& graph,
                                             const PrecomputedOptions& options = {},
                                             const std::stop_token& stop = {});

// Whether WritePrecomputed() can begin; leaves no trace. Errors: as above.
absl::Status CheckPrecomputedFolder(const std::string& folder);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PRECOMPUTED_H_
