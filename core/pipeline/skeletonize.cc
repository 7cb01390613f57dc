#include "core/certificate/describe_changes.h"
#include "core/distance/distance_field.h"
#include "core/distance/exact_radius.h"
#include "core/exec/machine_memory.h"
#include "core/exec/stage_clock.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/pipeline/algorithm_version.h"
#include "core/pipeline/at_border.h"
#include "core/pipeline/canonical_options.h"
#include "core/pipeline/method_in_words.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/prepare/beyond_border.h"
#include "core/prepare/border_cuts.h"
#include "core/prepare/brick_sets.h"
#include "core/pruning/point_table.h"
#include "core/pruning/sheet_pruner.h"
#include "core/skeleton/center_curves.h"
#include "core/skeleton/trace_skeleton.h"
#include "core/skeleton/voxel_radii.h"

namespace bccskel {
namespace {

// Returns the radii that the graph had.
// Needs: the points of the graph are those of `thin`; `radii` in the order of its ForEachPoint().
std::vector<float> SetRadii(const std::vector<float>& radii, const Volume& thin,
                            SkeletonGraph& graph) {
  PointTable<float> by_point;
  by_point.Reserve(radii.size());
  size_t n = 0;
  thin.ForEachPoint([&](LatticePoint p) { by_point.Set(p, radii[n++]); });
  std::vector<float> before;
  before.reserve(graph.points.size());
  for (SkeletonPoint& p : graph.points) {
    before.push_back(std::exchange(p.radius, *by_point.Find(p.point)));
  }
  return before;
}

// Points that stay although they may be simple: isthmuses, if they do not form curves, and those
// that the caller keeps.
Volume SparedPoints(const ThinSkeleton& skeleton, const ThinningOptions& thinning) {
  VolumeBuilder spared(skeleton.points.extent(), skeleton.points.placement());
  if (!HasCurves(thinning) && !skeleton.births.empty()) {
    size_t n = 0;
    skeleton.points.ForEachPoint([&](LatticePoint p) {
      if (skeleton.births[n++] > 0) spared.Add(p);
    });
  }
  for (LatticePoint p : thinning.keep) spared.Add(p);
  absl::StatusOr<Volume> volume = std::move(spared).Build();
  return volume.ok() ? *std::move(volume) : Volume();  // an empty extent has no points
}

SimplePoints ThatMayGo(const SkeletonizeOptions& options) {
  const SkeletonKind kind = options.thinning.kind;
  const bool ends_stay =
      HasCurves(options.thinning) || kind == SkeletonKind::kCurve || kind == SkeletonKind::kSurface;
  return ends_stay ? SimplePoints::kNonEnd : SimplePoints::kAll;
}

// `certificate` has the numbers of the object.
absl::Status Certify(const Volume& thin, const exec::Context& context, Certificate& certificate) {
  BCCSKEL_ASSIGN_OR_RETURN(certificate.skeleton, CountBettiNumbers(thin, context));
  if (certificate.TopologyKept()) return absl::OkStatus();
  return absl::InternalError("thinning changed the topology: " +
                             DescribeChanges(certificate.input, certificate.skeleton));
}

DistanceField NoDistances(DistanceKind kind) {
  return DistanceField(kind, ChamferWeights(), DistanceField::Values(), 0);
}

// Radii of few points are searched for one by one, and so are the distances that center their
// curves. A search costs about as much as measuring one brick (0.6 to 2 on objects of 850,000
// points) and needs no memory; both give the same bits.
absl::Status PrepareRadii(const Volume& object, uint64_t searches, DistanceField& distance,
                          const exec::Context& context) {
  if (distance.kind() == DistanceKind::kEuclidean) return absl::OkStatus();
  if (searches <= object.brick_count()) return absl::OkStatus();
  distance = NoDistances(distance.kind());
  BCCSKEL_ASSIGN_OR_RETURN(distance, ComputeDistance(object, DistanceKind::kEuclidean, context));
  return absl::OkStatus();
}

// The stages in order, and the data that they pass on.
class Pipeline {
 public:
  // `peeler` may be null: then this process peels.
  Pipeline(const SkeletonizeOptions& options, exec::MemoryBudget& memory,
           const exec::Context& context, const OnShellPoints& on_points, const Peeler* peeler)
      : options_(options),
        memory_(memory),
        context_(context),
        on_points_(on_points),
        peeler_(peeler),
        thinning_(options.thinning) {
    result_.options = CanonicalOptions(options);
    result_.options.thinning.keep.clear();
    result_.certificate.sampled = options.source == ObjectSource::kSampledVoxels;
    result_.method = MethodInWords(options.thinning, options.distance, options.source);
    result_.algorithm_version = AlgorithmVersionOf(options.source);
  }

  // The whole object replaces the given part.
  absl::StatusOr<SkeletonizeResult> RunByPeeler(Volume& given) && {
    result_.options.border = Border::kEnds;
    if (options_.preparing.Wanted()) {
      BCCSKEL_ASSIGN_OR_RETURN(Volume prepared, PrepareObject(given));
      BCCSKEL_RETURN_IF_ERROR(PeelAndRun(prepared));
    } else {
      BCCSKEL_RETURN_IF_ERROR(PeelAndRun(given));
    }
    return std::move(result_);
  }

  absl::StatusOr<SkeletonizeResult> Run(const Volume& given) && {
    if (!options_.preparing.Wanted()) {
      BCCSKEL_RETURN_IF_ERROR(RunFrom(given));
    } else {
      BCCSKEL_ASSIGN_OR_RETURN(const Volume object, PrepareObject(given));
      BCCSKEL_RETURN_IF_ERROR(RunFrom(object));
    }
    return std::move(result_);
  }

 private:
  absl::StatusOr<Volume> PrepareObject(const Volume& given) {
    BCCSKEL_ASSIGN_OR_RETURN(
        PreparedObject prepared,
        Prepare(given, options_.preparing, memory_, context_, CellsPerVoxel(options_.source)));
    result_.certificate.unprepared = prepared.before;
    result_.preparing = std::move(prepared.steps);
    result_.timings.preparing = clock_.Lap();
    return std::move(prepared.object);
  }

  absl::Status RunFrom(const Volume& object) {
    result_.object_points = object.PointCount();
    if (!object.empty()) BCCSKEL_RETURN_IF_ERROR(LookBeyondBorder(object));
    return RunIn(object);
  }

  absl::Status LookBeyondBorder(const Volume& object) {
    BCCSKEL_ASSIGN_OR_RETURN(
        const BeyondFaces beyond,
        FindFaces(object, options_, result_.options.border, memory_, context_));
    result_.options.border = beyond.stated;
    if (beyond.faces == kNoFaces) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(
        Volume space, ContinueBeyond(beyond.faces, object, LastPointsOf(options_.source), memory_));
    if (space.window().has_value()) space_.emplace(std::move(space));
    return absl::OkStatus();
  }

  // The volume in which widths and distances are measured.
  const Volume& SpaceOf(const Volume& object) const {
    return space_.has_value() ? *space_ : object;
  }

  absl::Status RunIn(const Volume& object) {
    DistanceField distance = NoDistances(options_.distance);
    BCCSKEL_RETURN_IF_ERROR(Thin(object, distance));
    return FinishIn(object, std::move(distance));
  }

  // A peeler does not return distances, so radii are searched for.
  absl::Status PeelAndRun(Volume& object) {
    BCCSKEL_ASSIGN_OR_RETURN(PeeledObject peeled, (*peeler_)(object, thinning_));
    TakeOver(std::move(peeled.thinned));
    result_.object_points = peeled.points;
    result_.certificate.input = peeled.topology;
    return FinishIn(object, NoDistances(DistanceKind::kChamfer));
  }

  absl::Status FinishIn(const Volume& object, DistanceField distance) {
    BCCSKEL_RETURN_IF_ERROR(memory_.TakeFor(skeleton_.points.PointCount(), kBytesPerThinPoint,
                                            "points that thinning leaves"));
    BCCSKEL_RETURN_IF_ERROR(MeasureAndPrune(object, distance));
    if (peeler_ == nullptr) {
      BCCSKEL_ASSIGN_OR_RETURN(result_.certificate.input, CountBettiNumbers(object, context_));
    }
    BCCSKEL_RETURN_IF_ERROR(Certify(skeleton_.points, context_, result_.certificate));
    result_.certificate.simple_points_left = CountSimplePoints(
        skeleton_.points, ThatMayGo(options_), SparedPoints(skeleton_, thinning_), context_);
    result_.timings.certificate = clock_.Lap();
    const std::vector<float> exact = skeleton_.radii;
    BCCSKEL_ASSIGN_OR_RETURN(skeleton_.radii, StatedRadii(object, exact));
    BCCSKEL_ASSIGN_OR_RETURN(result_.graph, TraceSkeleton(skeleton_, memory_, context_));
    BCCSKEL_RETURN_IF_ERROR(
        MergeJunctions(result_.options.junction_reach, context_, result_.graph));
    BCCSKEL_RETURN_IF_ERROR(Center(object, distance, exact));
    result_.thin = std::move(skeleton_.points);
    BCCSKEL_ASSIGN_OR_RETURN(result_.sha256, SkeletonDigest(result_.graph, context_));
    result_.timings.graph = clock_.Lap();
    result_.timings.total = clock_.Total();
    return absl::OkStatus();
  }

  // The radii stated in the result. Nodes are chosen and junctions merged by these, so that pruning
  // can be repeated from the result alone (ForEachPrunedGraph()).
  absl::StatusOr<std::vector<float>> StatedRadii(const Volume& object,
                                                 const std::vector<float>& exact) {
    if (!IsConverted(options_.source)) return exact;
    const Volume& space = SpaceOf(object);
    if (!search_.has_value()) search_.emplace(space);
    const auto voxel_units = static_cast<int32_t>(SurfaceStepOf(options_.source));
    BCCSKEL_ASSIGN_OR_RETURN(
        std::vector<float> radii,
        MeasureVoxelRadii(space, voxel_units, *search_, skeleton_.points, exact, context_));
    if (options_.border == Border::kContinues) return radii;
    BCCSKEL_RETURN_IF_ERROR(
        MeasureAtBorder(object, options_, at_border_, skeleton_.points, memory_, context_, radii));
    return radii;
  }

  // Curves are centered in discs as wide as the exact radii.
  absl::Status Center(const Volume& object, DistanceField& distance,
                      const std::vector<float>& exact) {
    if (options_.distance != DistanceKind::kEuclidean) return absl::OkStatus();
    if (MayMeasureAnew()) {
      const uint64_t searches = kMostDistancesOfPoint * skeleton_.points.PointCount();
      BCCSKEL_RETURN_IF_ERROR(PrepareRadii(object, searches, distance, context_));
    }
    std::vector<float> stated;
    if (exact != skeleton_.radii) stated = SetRadii(exact, skeleton_.points, result_.graph);
    BCCSKEL_RETURN_IF_ERROR(CenterCurves(object, distance, context_, result_.graph));
    DropShifts(at_border_, result_.graph);
    for (size_t n = 0; n < stated.size(); ++n) result_.graph.points[n].radius = stated[n];
    return absl::OkStatus();
  }

  // Shells are made while chamfer distances are measured; shells and depths while Euclidean
  // distances are.
  bool NeedsField() const {
    const bool depths = DepthsOf(thinning_.method) == Depths::kWanted;
    return space_.has_value() || (depths && options_.distance != DistanceKind::kEuclidean);
  }

  // Whether the distances of the object, if they were not kept, may be measured once more.
  bool MayMeasureAnew() const { return peeler_ == nullptr && !space_.has_value(); }

  absl::StatusOr<DistanceField> MeasureDistances(const Volume& object, DistanceKind kind) {
    return space_.has_value() ? MeasureIn(*space_, object, kind, context_)
                              : ComputeDistance(object, kind, context_);
  }

  absl::Status Thin(const Volume& object, DistanceField& distance) {
    return NeedsField() ? ThinInField(object, distance) : ThinInShells(object, distance);
  }

  absl::Status ThinInField(const Volume& object, DistanceField& distance) {
    BCCSKEL_ASSIGN_OR_RETURN(distance, MeasureDistances(object, options_.distance));
    if (result_.options.border != Border::kContinuesAcrossSlice && HasCurves(thinning_)) {
      cuts_ = FindBorderCuts(SpaceOf(object), object, distance);
      thinning_.keep.insert(thinning_.keep.end(), cuts_.middles.begin(), cuts_.middles.end());
    }
    result_.timings.distance = clock_.Lap();
    BCCSKEL_ASSIGN_OR_RETURN(ThinningResult thinned,
                             ThinObject(object, distance, thinning_, context_, on_points_));
    TakeOver(std::move(thinned));
    return absl::OkStatus();
  }

  absl::Status ThinInShells(const Volume& object, DistanceField& distance) {
    BCCSKEL_ASSIGN_OR_RETURN(const EuclideanShells measured, MeasureShells(object, distance));
    result_.timings.distance = clock_.Lap();
    BCCSKEL_ASSIGN_OR_RETURN(
        ThinningResult thinned,
        ThinByShells(object, measured.shells, measured.depths, thinning_, context_, on_points_));
    TakeOver(std::move(thinned));
    return absl::OkStatus();
  }

  absl::StatusOr<EuclideanShells> MeasureShells(const Volume& object, DistanceField& distance) {
    EuclideanShells measured;
    if (options_.distance != DistanceKind::kEuclidean) {
      BCCSKEL_ASSIGN_OR_RETURN(measured.shells, StreamShells(object, options_.distance,
                                                             thinning_.shell_width, context_));
      return measured;
    }
    BCCSKEL_ASSIGN_OR_RETURN(measured, StreamEuclideanShells(object, thinning_.shell_width,
                                                             DepthsOf(thinning_.method), context_));
    distance = measured.distance.has_value() ? *std::exchange(measured.distance, {})
                                             : NoDistances(DistanceKind::kChamfer);
    return measured;
  }

  void TakeOver(ThinningResult thinned) {
    const SkeletonKind kind = thinning_.kind;
    if (kind == SkeletonKind::kSurface || kind == SkeletonKind::kIsthmusCurve) {
      skeleton_.births = BirthsOf(thinned);
    }
    skeleton_.points = std::move(thinned.thin);
    result_.last_shell = thinned.last_shell;
    result_.timings.shells = thinned.times.shells;
    result_.timings.thinning = thinned.times.passes;
    result_.timings.cleanup = thinned.times.cleanup;
    clock_.Lap();
  }

  absl::Status MeasureAndPrune(const Volume& object, DistanceField& distance) {
    if (MayMeasureAnew()) {
      // Centering comes later, and how many points pruning leaves for it is not known yet. If it
      // then needs the field, at most a quarter of the field's cost was spent on searches.
      const uint64_t searches =
          (options_.distance == DistanceKind::kEuclidean ? 4 : 1) * skeleton_.points.PointCount();
      BCCSKEL_RETURN_IF_ERROR(PrepareRadii(object, searches, distance, context_));
    } else if (peeler_ == nullptr && distance.kind() != DistanceKind::kEuclidean) {
      BCCSKEL_ASSIGN_OR_RETURN(distance, MeasureDistances(object, DistanceKind::kEuclidean));
    }
    const ExactRadius radius(object, distance);
    BCCSKEL_ASSIGN_OR_RETURN(skeleton_.radii, ExactRadii(skeleton_.points, radius, context_));
    if (IsConverted(options_.source) && !space_.has_value()) {
      search_.emplace(radius.searches() ? radius : ExactRadius(object));
    }
    if (HasCurves(thinning_)) {
      const ExactRadius& single = search_.has_value() ? *search_ : radius;
      BCCSKEL_ASSIGN_OR_RETURN(
          ThinSkeleton pruned,
          Prune(skeleton_,
                {object, single, SurfaceStepOf(options_.source), options_.voxel_slabs,
                 &SpaceOf(object), ImageThatCuts(object.extent(), options_), &cuts_},
                options_.thinning.keep, options_.pruning, context_));
      at_border_ = std::exchange(pruned.at_border, {});
      TakeOver(std::move(pruned));
    }
    const PruningOptions& pruning = result_.options.pruning;
    if (HasSheets(thinning_) && pruning.rule != PruningRule::kNone) {
      BCCSKEL_ASSIGN_OR_RETURN(ThinSkeleton pruned,
                               PruneSheets(skeleton_, pruning.threshold, thinning_.keep, context_));
      TakeOver(std::move(pruned));
    }
    result_.skeleton_points = skeleton_.points.PointCount();
    result_.timings.pruning = clock_.Lap();
    return absl::OkStatus();
  }

  void TakeOver(ThinSkeleton pruned) {
    if (on_points_) {
      on_points_(result_.last_shell + 1, Difference(skeleton_.points, pruned.points));
    }
    skeleton_ = std::move(pruned);
  }

  const SkeletonizeOptions& options_;
  exec::MemoryBudget& memory_;
  const exec::Context& context_;
  const OnShellPoints& on_points_;
  const Peeler* const peeler_;
  exec::StageClock clock_;
  ThinSkeleton skeleton_;
  std::optional<Volume> space_;  // the object in a window, where it continues beyond the border
  BorderCuts cuts_;              // of limbs, at that border
  PointsByAxis at_border_;       // of curves that lead to where the border cuts limbs off
  ThinningOptions thinning_;     // keeps the middles of these cuts, too
  std::optional<ExactRadius> search_;  // where radii of voxels are measured
  SkeletonizeResult result_;
};

}  // namespace

absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object,
                                              const SkeletonizeOptions& options,
                                              const exec::Context& context,
                                              const OnShellPoints& on_points) {
  exec::MachineMemory memory;
  return SkeletonizeWithin(memory, object, options, context, on_points);
}

absl::StatusOr<SkeletonizeResult> SkeletonizeWithin(exec::MemoryBudget& memory,
                                                    const Volume& object,
                                                    const SkeletonizeOptions& options,
                                                    const exec::Context& context,
                                                    const OnShellPoints& on_points) {
  BCCSKEL_RETURN_IF_ERROR(CheckSkeletonizeOptions(options));
  return Pipeline(options, memory, context, on_points, nullptr).Run(object);
}

absl::StatusOr<SkeletonizeResult> SkeletonizeBy(const Peeler& peeler, Volume& object,
                                                const SkeletonizeOptions& options,
                                                const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckSkeletonizeOptions(options));
  if (options.border == Border::kContinues ||
      AxisOfOneSlice(object.extent(), options).has_value()) {
    return absl::InvalidArgumentError("an object that is peeled elsewhere must end at its border");
  }
  exec::MachineMemory memory;
  return Pipeline(options, memory, context, nullptr, &peeler).RunByPeeler(object);
}

}  // namespace bccskel
