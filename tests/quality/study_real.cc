#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "core/import/image/foreground.h"
#include "core/import/image/open_image.h"
#include "core/import/mesh/mesh_file.h"
#include "core/import/voxelize/voxelize.h"
#include "tests/quality/hair.h"
#include "tests/quality/measure.h"
#include "tests/quality/studies.h"

// Real masks and meshes, whose true tips nobody knows.

namespace bccskel::quality {
namespace {

constexpr double kOpen = ForegroundRule::kOpen;

// What is the object in the volumes of the reference data.
struct RealMask {
  const char* file;
  const char* kind;
  double low;
  double high = kOpen;
};
constexpr RealMask kRealMasks[] = {
    {"neuron_28648864.nrrd", "neuron", 1},
    {"neuron_28018323.nrrd", "neuron", 1},
    {"neuron_28794499.nrrd", "neuron", 1},
    {"airway_p4_chopped.nrrd", "airway", 1},
    {"poon2015_BBB_noLeakage_manualLabel_v2.tif", "vessels", 1},
    {"santos2015_lowContrastVessels_labelsMarc.tif", "vessels", 1},
    {"aorta-final-levelset.mha", "vessels", -kOpen, -1e-30},
    {"Al.100.vol", "other", 1},
    {"cat10b.vol", "other", 1},
    {"lobster.vol", "scan", 40},
    {"lobsterCroped2.nii.gz", "scan", 40},
    {"liver.inr.gz", "scan", 127, 127},
    {"100_fiberform.tif", "scan", 90},
};

absl::StatusOr<VoxelMask> ReadMask(const std::string& path, const RealMask& real) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto source, OpenImage(path));
  BCCSKEL_ASSIGN_OR_RETURN(const ForegroundRule rule, ForegroundRule::Range(real.low, real.high));
  const ImageInfo& info = source->info();
  VoxelMask mask({info.size.nx, info.size.ny, info.size.nz, info.placement});
  for (int32_t z = 0; z < info.size.nz; ++z) {
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source->NextSlice());
    ForegroundSlice(slice, rule, mask.Slice(z));
  }
  return mask;
}

absl::Status PrintVoxelsOf(const RealMask& real, VoxelMask mask, const StudyOptions&) {
  const MaskGrid& grid = mask.grid();
  absl::PrintF(
      "{\"mask\": \"%s\", \"shape\": [%d, %d, %d], \"spacing\": [%s]}\n", real.file, grid.nz,
      grid.ny, grid.nx,
      absl::StrJoin(
          {grid.placement.spacing[2], grid.placement.spacing[1], grid.placement.spacing[0]}, ", "));
  const size_t row = static_cast<size_t>(grid.nx), slice = row * static_cast<size_t>(grid.ny);
  std::vector<uint8_t> bits((slice * static_cast<size_t>(grid.nz) + 7) / 8);
  mask.ForEachVoxel([&](Voxel v) {
    const size_t n = static_cast<size_t>(v[2]) * slice + static_cast<size_t>(v[1]) * row +
                     static_cast<size_t>(v[0]);
    bits[n / 8] = static_cast<uint8_t>(bits[n / 8] | 1u << n % 8);
  });
  const size_t written = std::fwrite(bits.data(), 1, bits.size(), stdout);
  if (written != bits.size()) return absl::DataLossError("the voxels could not be written");
  return absl::OkStatus();
}

absl::Status StudyRealMask(const RealMask& real, VoxelMask mask, const StudyOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(const MaskObject object, Convert(mask, options.skeleton));
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                           Skeletonize(object.volume, object.options, exec::Context()));
  const Hair hair = HairOf(result.graph);
  const BettiNumbers& topology = result.certificate.skeleton;
  const int ends = CountNodes(result.graph, NodeKind::kEnd);
  const int missed = CountMissedParts(result.graph, mask);
  const double seconds = std::chrono::duration<double>(result.timings.total).count();
  if (options.json) {
    absl::PrintF(
        "{\"study\": \"real-masks\", \"mask\": \"%s\", \"kind\": \"%s\", \"voxels\": %d, "
        "\"components\": %d, \"loops\": %d, \"ends\": %d, \"twigs\": %d, "
        "\"redundant_length\": %.5f, \"missed\": %d, \"branches\": %d, \"seconds\": %.3f}\n",
        real.file, real.kind, mask.Count(), topology.components, topology.loops, ends, hair.twigs,
        hair.redundant_length, missed, result.graph.edges.size(), seconds);
  } else {
    absl::PrintF("%-32.32s %-8s %8d %5d %5d %6d %6d %8.2f%% %6d %8d %8.2f\n", real.file, real.kind,
                 mask.Count(), topology.components, topology.loops, ends, hair.twigs,
                 100 * hair.redundant_length, missed, result.graph.edges.size(), seconds);
  }
  std::fflush(stdout);
  return absl::OkStatus();
}

template <typename Study>
absl::Status ForEachRealMask(const StudyOptions& options, Study study) {
  for (const RealMask& real : kRealMasks) {
    const std::string path = options.data + "/volume/" + real.file;
    if (!options.Wants(real.file) || !std::filesystem::exists(path)) continue;
    BCCSKEL_ASSIGN_OR_RETURN(VoxelMask mask, ReadMask(path, real));
    BCCSKEL_RETURN_IF_ERROR(study(real, std::move(mask), options));
  }
  return absl::OkStatus();
}

// The skeleton of a mesh in the world before the turn.
struct Pose {
  int ends = 0;
  std::vector<Vector> places = {};  // of the skeleton's points
  std::vector<Vector> smooth = {};  // the same on the smooth curves, as .swc files have them
  std::vector<double> radii = {};
};

// The position moved by its shift.
WorldPoint ShiftedPositionOf(const SkeletonGraph& graph, const SkeletonPoint& p) {
  const auto shifted = [&](int32_t coordinate, size_t axis) {
    return coordinate + p.shift[axis] / static_cast<double>(kShiftUnits);
  };
  return graph.placement.ToWorld(shifted(p.point.x, 0), shifted(p.point.y, 1),
                                 shifted(p.point.z, 2));
}

absl::StatusOr<Pose> PoseOf(TriangleMesh mesh, uint64_t points, const Frame& frame,
                            LatticeAxes axes, const SkeletonizeOptions& options) {
  for (TriangleMesh::Vertex& v : mesh.vertices) {
    const Vector turned = frame.Turn({v[0], v[1], v[2]});
    v = {turned.x, turned.y, turned.z};
  }
  BCCSKEL_ASSIGN_OR_RETURN(const VoxelizeResult solid,
                           Voxelize(mesh, {.points = points, .axes = axes}, exec::Context()));
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                           Skeletonize(solid.volume, options, exec::Context()));
  const SkeletonGraph& graph = result.graph;
  Pose pose = {.ends = CountNodes(graph, NodeKind::kEnd)};
  const auto in_frame = [&](const WorldPoint& at) { return frame.TurnBack({at[0], at[1], at[2]}); };
  for (const SkeletonPoint& p : graph.points) {
    pose.places.push_back(in_frame(ShiftedPositionOf(graph, p)));
    pose.radii.push_back(graph.RadiusOf(p));
  }
  for (const SkeletonEdge& edge : graph.edges) {
    for (const WorldPoint& at : SmoothCurve(graph, edge)) pose.smooth.push_back(in_frame(at));
  }
  return pose;
}

using Places = std::vector<Vector> Pose::*;

// From each place of one to the nearest of the other, over the radius there.
void AddDistances(const Pose& from, const Pose& to, Places places, std::vector<double>& distances) {
  for (size_t n = 0; n < (from.*places).size(); ++n) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector& q : to.*places) {
      const Vector way = (from.*places)[n] - q;
      nearest = std::min(nearest, Dot(way, way));
    }
    distances.push_back(std::sqrt(nearest) / from.radii[n]);
  }
}

// In both ways, sorted.
std::vector<double> DistancesBetween(const Pose& a, const Pose& b, Places places) {
  std::vector<double> distances;
  AddDistances(a, b, places, distances);
  AddDistances(b, a, places, distances);
  std::ranges::sort(distances);
  return distances;
}

double Percentile95(const std::vector<double>& sorted) {
  return sorted.empty() ? 0 : sorted[sorted.size() * 95 / 100];
}

// How far the skeletons of random poses differ.
struct Differences {
  std::string ends;  // numbers, separated by commas
  double p95 = 0, smooth = 0, largest = 0;
};

absl::StatusOr<Differences> DifferencesBetweenPoses(const TriangleMesh& mesh, LatticeAxes axes,
                                                    const StudyOptions& options) {
  Differences differences;
  std::vector<int> ends;
  Pose first;
  for (int turn = 0; turn < options.turns; ++turn) {
    BCCSKEL_ASSIGN_OR_RETURN(
        Pose pose, PoseOf(mesh, options.points.front(), RandomFrame(static_cast<uint64_t>(turn)),
                          axes, options.skeleton));
    ends.push_back(pose.ends);
    if (turn == 0) {
      first = std::move(pose);
      continue;
    }
    const std::vector<double> distances = DistancesBetween(first, pose, &Pose::places);
    differences.p95 = std::max(differences.p95, Percentile95(distances));
    if (!distances.empty()) {
      differences.largest = std::max(differences.largest, distances.back());
    }
    differences.smooth =
        std::max(differences.smooth, Percentile95(DistancesBetween(first, pose, &Pose::smooth)));
  }
  differences.ends = absl::StrJoin(ends, ", ");
  return differences;
}

absl::Status StudyClosedMesh(const std::string& path, const StudyOptions& options) {
  const std::string name = std::filesystem::path(path).filename();
  BCCSKEL_ASSIGN_OR_RETURN(const TriangleMesh mesh, ReadMeshFile(path));
  std::vector<int> sizes;
  for (const uint64_t points : options.points) {
    BCCSKEL_ASSIGN_OR_RETURN(const Pose pose,
                             PoseOf(mesh, points, Frame(), LatticeAxes::kShape, options.skeleton));
    sizes.push_back(pose.ends);
  }
  BCCSKEL_ASSIGN_OR_RETURN(const Differences own,
                           DifferencesBetweenPoses(mesh, LatticeAxes::kShape, options));
  BCCSKEL_ASSIGN_OR_RETURN(const Differences world,
                           DifferencesBetweenPoses(mesh, LatticeAxes::kWorld, options));
  const std::string by_size = absl::StrJoin(sizes, ", ");
  if (options.json) {
    absl::PrintF(
        "{\"study\": \"closed meshes\", \"mesh\": \"%s\", \"points\": [%s], \"ends\": [%s], "
        "\"pose_ends\": [%s], \"p95\": %.4f, \"world_pose_ends\": [%s], \"world_p95\": %.4f, "
        "\"world_smooth_p95\": %.4f, \"world_largest\": %.3f}\n",
        name, absl::StrJoin(options.points, ", "), by_size, own.ends, own.p95, world.ends,
        world.p95, world.smooth, world.largest);
  } else {
    absl::PrintF("%-24s %-20s %-28s %6.2f %-28s %6.2f %6.2f %8.2f\n", name, by_size, own.ends,
                 own.p95, world.ends, world.p95, world.smooth, world.largest);
  }
  std::fflush(stdout);
  return absl::OkStatus();
}

}  // namespace

absl::Status StudyRealMasks(const StudyOptions& options) {
  if (!options.json) {
    absl::PrintF("%-32s %-8s %8s %5s %5s %6s %6s %9s %6s %8s %8s\n", "mask", "kind", "voxels",
                 "comps", "loops", "ends", "twigs", "redundant", "missed", "branches", "seconds");
  }
  return ForEachRealMask(options, StudyRealMask);
}

absl::Status PrintRealVoxels(const StudyOptions& options) {
  return ForEachRealMask(options, PrintVoxelsOf);
}

absl::Status StudyClosedMeshes(const StudyOptions& options) {
  if (!options.json) {
    absl::PrintF("%-24s %-20s %-28s %6s %-28s %6s %6s %8s\n", "mesh", "ends by size",
                 "ends by pose", "p95", "the same, axes of the world", "p95", "smooth", "largest");
  }
  std::error_code error;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(options.data + "/mesh", error)) {
    const std::string path = entry.path();
    // Open ones have no inside.
    const bool is_open = path.find("open") != std::string::npos;
    if (IsMeshPath(path) && !is_open && options.Wants(path)) paths.push_back(path);
  }
  if (error) {
    return absl::NotFoundError(options.data + "/mesh: " + error.message() +
                               "; --data names the folder of the reference data");
  }
  std::ranges::sort(paths);
  for (const std::string& path : paths) BCCSKEL_RETURN_IF_ERROR(StudyClosedMesh(path, options));
  return absl::OkStatus();
}

}  // namespace bccskel::quality
