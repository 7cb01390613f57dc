#ifndef BCCSKEL_CORE_PIPELINE_SKELETONIZE_H_
#define BCCSKEL_CORE_PIPELINE_SKELETONIZE_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/pipeline/stage_timings.h"
#include "core/prepare/prepare.h"
#include "core/pruning/prune.h"
#include "core/skeleton/junction_merger.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"

namespace bccskel {

// The source of the object's points.
enum class ObjectSource : uint8_t {
  kPoints,         // lattice points of a solid
  kVoxels,         // a mask, converted exactly with two points per voxel
  kRefinedVoxels,  // the same with sixteen points per voxel
  kSampledVoxels,  // a mask, sampled: its topology may have changed
};

// The height of the steps of the object's surface in lattice units: the edge of a voxel, which is
// approximate for samplings.
double SurfaceStepOf(ObjectSource source);

// How many edges of the cubic cell make an edge of a voxel; 1 for objects without voxels.
int32_t CellsPerVoxel(ObjectSource source);

// What lies beyond the border of the lattice, or of the image from which it was made. Across an
// image of one slice objects always continue.
enum class Border : uint8_t {
  // Of masks: as kContinues beyond the faces that cut limbs off (FacesThatCutLimbs()), as kEnds
  // beyond the others. Results state kEnds if there are no such faces. Of other objects, and for
  // skeletons without curves: kEnds.
  kAuto,
  kEnds,  // background; but curves of limbs of masks that are cut off there lead straight to it
  kContinues,  // unknown: thinning itself leads a limb that is cut off there to the border
  // As kContinues beyond both faces of an image of one slice, background beyond its other borders:
  // what the others mean for such an image. Only results state it.
  kContinuesAcrossSlice,
};

struct SkeletonizeOptions {
  PreparingOptions preparing = {};
  // The symmetric method centers curves better than the paper's directional one.
  ThinningOptions thinning = {.method = ThinningMethod::kSymmetric};
  // Defines the shells. Euclidean distances center curves better than chamfer distances, and also
  // give the exact radii.
  DistanceKind distance = DistanceKind::kEuclidean;
  // Skipped if thinning stops at a shell, which leaves no curves.
  PruningOptions pruning = {};
  ObjectSource source = ObjectSource::kPoints;
  // The number of slabs into which the voxels of a mask were cut along x, y and z because they were
  // long. The noise of the mask is longer by this factor than the lattice suggests. 1 to 8.
  std::array<int32_t, 3> voxel_slabs = {1, 1, 1};
  // Merges junctions within this many radii of each other; 0 merges none. Only for graphs of
  // curves.
  double junction_reach = kDefaultJunctionReach;
  Border border = Border::kAuto;
};

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckSkeletonizeOptions(const SkeletonizeOptions& options);

struct SkeletonizeResult {
  SkeletonGraph graph;
  Volume thin;
  Certificate certificate;
  StageTimings timings;
  SkeletonizeOptions options;            // CanonicalOptions(), without the points to keep
  std::vector<PreparingStep> preparing;  // what was done to the object before thinning
  uint64_t object_points = 0;            // after preparing
  uint64_t skeleton_points = 0;
  int32_t last_shell = 0;
  std::string method;             // MethodInWords()
  std::string algorithm_version;  // AlgorithmVersionOf() of the program that made this
  std::string sha256;             // SkeletonDigest(graph)
};

// Runs all stages: preparing, distance, shells, thinning, pruning, certificate, graph. An empty
// object gives an empty graph. `on_points`, if given, receives all points that are removed; those
// that pruning removes come after the shells. A tip that moves outward may add points again.
// Errors: INVALID_ARGUMENT (options); RESOURCE_EXHAUSTED (preparing makes too large an object, or
//         thinning leaves more points than fit this machine's memory); CANCELLED,
//         DEADLINE_EXCEEDED; INTERNAL if the certificate shows that topology was lost, which would
//         be a defect of this library.
absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object,
                                              const SkeletonizeOptions& options,
                                              const exec::Context& context,
                                              const OnShellPoints& on_points = nullptr);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_SKELETONIZE_H_
