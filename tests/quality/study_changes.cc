#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/export/reconstruct/overlap.h"
#include "core/export/reconstruct/union_of_balls.h"
#include "core/import/mesh/mesh_file.h"
#include "core/import/voxelize/voxelize.h"
#include "tests/quality/disturb.h"
#include "tests/quality/known_figure.h"
#include "tests/quality/measure.h"
#include "tests/quality/methods.h"
#include "tests/quality/studies.h"

// What changes in a skeleton when what it should not depend on does.

namespace bccskel::quality {
namespace {

struct Change {
  SetDistance raw;
  SetDistance smooth;
  int ends = 0;  // more than before
};

void PrintChange(const std::string& study, const std::string& what, const char* method,
                 const std::string& change, const Change& measured) {
  absl::PrintF(
      "{\"study\": \"%s\", \"figure\": \"%s\", \"method\": \"%s\", \"change\": \"%s\", "
      "\"mean\": %.4f, \"largest\": %.3f, \"smooth_mean\": %.4f, \"smooth_largest\": %.3f, "
      "\"ends\": %d}\n",
      study, what, method, change, measured.raw.mean, measured.raw.largest, measured.smooth.mean,
      measured.smooth.largest, measured.ends);
}

int EndsOf(const SkeletonizeResult& result) { return CountNodes(result.graph, NodeKind::kEnd); }

std::vector<Vector> TurnedBack(std::vector<Vector> points, const GridRotation& rotation,
                               LatticePoint shift) {
  for (Vector& p : points) {
    const std::array<double, 3> from = {p.x - shift.x, p.y - shift.y, p.z - shift.z};
    std::array<double, 3> to = {};
    for (size_t n = 0; n < 3; ++n) {
      to[static_cast<size_t>(rotation.axis[n])] = rotation.sign[n] * from[n];
    }
    p = {to[0], to[1], to[2]};
  }
  return points;
}

absl::Status StudyGridRotations(const PlacedFigure& placed, const Method& method) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult first, SkeletonizeBy(method, placed.object));
  for (const GridRotation& rotation : GridRotations()) {
    const TurnedVolume turned = TurnedOnGrid(placed.object, rotation);
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult other, SkeletonizeBy(method, turned.object));
    const auto back = [&](std::vector<Vector> points) {
      return TurnedBack(std::move(points), rotation, turned.shift);
    };
    PrintChange("rotations", placed.figure.name, method.name, "grid",
                {DistanceBetween(RawPoints(first.graph), back(RawPoints(other.graph))),
                 DistanceBetween(SmoothPoints(first.graph), back(SmoothPoints(other.graph))),
                 EndsOf(other) - EndsOf(first)});
  }
  return absl::OkStatus();
}

// In lattice units from the figure's origin, turned back.
std::vector<Vector> InFigure(std::vector<Vector> points, const PlacedFigure& placed,
                             const Frame& frame) {
  for (Vector& p : points) p = frame.TurnBack(p - placed.shift);
  return points;
}

absl::Status StudyFreeRotations(const KnownFigure& figure, const StudyOptions& size,
                                const Method& method) {
  BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure still, Place(figure, size.points.front()));
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult first, SkeletonizeBy(method, still.object));
  for (int turn = 0; turn < size.turns; ++turn) {
    const Frame frame = RandomFrame(static_cast<uint64_t>(turn));
    KnownFigure turned = Turned(figure, frame);
    turned.scale = still.scale;
    BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure placed, Place(turned, size.points.front()));
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult other, SkeletonizeBy(method, placed.object));
    const auto change = [&](auto points_of) {
      return DistanceBetween(InFigure(points_of(first.graph), still, Frame()),
                             InFigure(points_of(other.graph), placed, frame));
    };
    PrintChange("rotations", figure.name, method.name, "free",
                {change(RawPoints), change(SmoothPoints), EndsOf(other) - EndsOf(first)});
  }
  return absl::OkStatus();
}

// The union of the balls of the graph, as `bccskel reconstruct` makes it, against the object.
absl::StatusOr<double> JaccardOfBalls(const Volume& object, const SkeletonGraph& graph) {
  BCCSKEL_ASSIGN_OR_RETURN(const Volume all, UnionOfBalls(BallsOf(graph), object.extent(),
                                                          object.placement(), exec::Context()));
  return MeasureOverlap(all, object).Jaccard();
}

absl::Status StudyBalls(const PlacedFigure& placed, const char* name,
                        const SkeletonizeOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                           Skeletonize(placed.object, options, exec::Context()));
  BCCSKEL_ASSIGN_OR_RETURN(const double jaccard, JaccardOfBalls(placed.object, result.graph));
  absl::PrintF(
      "{\"study\": \"reconstruction\", \"figure\": \"%s\", \"kind\": \"%s\", "
      "\"points\": %d, \"skeleton_points\": %d, \"jaccard\": %.4f}\n",
      placed.figure.name, name, result.object_points, result.skeleton_points, jaccard);
  return absl::OkStatus();
}

absl::StatusOr<SkeletonizeResult> PrintMesh(const std::string& name, double noise,
                                            const Method& method, const Volume& object) {
  BCCSKEL_ASSIGN_OR_RETURN(SkeletonizeResult result, SkeletonizeBy(method, object));
  absl::PrintF(
      "{\"study\": \"meshes\", \"figure\": \"%s\", \"method\": \"%s\", \"noise\": %g, "
      "\"points\": %d, \"ends\": %d, \"junctions\": %d, \"components\": %d, \"loops\": %d, "
      "\"simple_left\": %d, \"milliseconds\": %.2f}\n",
      name, method.name, noise, result.object_points, EndsOf(result),
      CountNodes(result.graph, NodeKind::kJunction), result.certificate.skeleton.components,
      result.certificate.skeleton.loops, result.certificate.simple_points_left,
      std::chrono::duration<double, std::milli>(result.timings.total).count());
  return result;
}

}  // namespace

absl::Status StudyRotations(const StudyOptions& size) {
  for (const KnownFigure& figure : KnownFigures()) {
    if (!figure.turns) continue;
    BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure placed,
                             Place(Turned(figure, RandomFrame(0)), size.points.front()));
    for (const Method& method : kMethods) {
      if (!IsMain(method)) continue;
      BCCSKEL_RETURN_IF_ERROR(StudyGridRotations(placed, method));
      BCCSKEL_RETURN_IF_ERROR(StudyFreeRotations(figure, size, method));
    }
  }
  return absl::OkStatus();
}

absl::Status StudyReconstruction(const StudyOptions& size) {
  for (const KnownFigure& figure : KnownFigures()) {
    const Frame frame = figure.turns ? RandomFrame(0) : Frame();
    BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure placed,
                             Place(Turned(figure, frame), size.points.front()));
    SkeletonizeOptions options;
    BCCSKEL_RETURN_IF_ERROR(StudyBalls(placed, "curve", options));
    options.thinning.stubble = StubblePolicy::kNone;
    options.pruning = {.rule = PruningRule::kNone, .tips = TipPlacement::kAsThinned};
    BCCSKEL_RETURN_IF_ERROR(StudyBalls(placed, "curve with stubble", options));
    options.thinning.stubble = StubblePolicy::kKeepTwo;
    options.thinning.kind = SkeletonKind::kSurface;
    BCCSKEL_RETURN_IF_ERROR(StudyBalls(placed, "surface", options));
  }
  return absl::OkStatus();
}

absl::Status StudyMesh(const StudyOptions& size) {
  const std::string& path = size.data;
  const std::string name = path.substr(path.rfind('/') + 1);
  BCCSKEL_ASSIGN_OR_RETURN(const TriangleMesh mesh, ReadMeshFile(path));
  BCCSKEL_ASSIGN_OR_RETURN(const VoxelizeResult solid,
                           Voxelize(mesh, {.points = size.points.front()}, exec::Context()));
  for (const Method& method : kMethods) {
    if (!IsMain(method)) continue;
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult clean,
                             PrintMesh(name, 0, method, solid.volume));
    for (const double noise : {0.02, 0.05}) {
      const Volume object = WithTopologyKeepingNoise(solid.volume, noise, 1);
      BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult other,
                               PrintMesh(name, noise, method, object));
      PrintChange("mesh noise", name, method.name, absl::StrFormat("%g", noise),
                  {DistanceBetween(RawPoints(clean.graph), RawPoints(other.graph)),
                   DistanceBetween(SmoothPoints(clean.graph), SmoothPoints(other.graph)),
                   EndsOf(other) - EndsOf(clean)});
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
