#include "core/certificate/describe_changes.h"
#include "core/distance/distance_field.h"
#include "core/distance/exact_radius.h"
#include "core/exec/machine_memory.h"
#include "core/exec/stage_clock.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/pipeline/algorithm_version.h"
#include "core/pipeline/canonical_options.h"
#include "core/pipeline/method_in_words.h"
#include "core/pipeline/pruned_graphs.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/pipeline/thin_points.h"
#include "core/prepare/beyond_border.h"
#include "core/pruning/sheet_pruner.h"
#include "core/skeleton/center_curves.h"
#include "core/skeleton/trace_skeleton.h"
#include "core/skeleton/voxel_radii.h"

namespace bccskel {
namespace {

// The points that stay though they may be simple: isthmuses where they are not made curves of, and
// those that the caller keeps.
Volume SparedPoints(const Volume& thin, const std::vector<IsthmusBirth>& isthmuses,
                    const ThinningOptions& thinning) {
  VolumeBuilder spared(thin.extent(), thin.placement());
  if (!HasCurves(thinning)) {
    for (const IsthmusBirth& birth : isthmuses) spared.Add(birth.point);
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

Volume PointsOnlyIn(const Volume& more, const Volume& less) {
  if (more.empty()) return more;
  VolumeBuilder builder(more.extent(), more.placement());
  more.ForEachPoint([&](LatticePoint p) {
    if (!less.Contains(p)) builder.Add(p);
  });
  return *std::move(builder).Build();
}

bool IsConverted(ObjectSource source) {
  return source == ObjectSource::kVoxels || source == ObjectSource::kRefinedVoxels;
}

DistanceField NoDistances(DistanceKind kind) {
  return DistanceField(kind, ChamferWeights(), DistanceField::Values(), 0);
}

// Radii of few points are searched for one by one, and so is what centers their curves. A search
// costs about as much as measuring one brick (0.6 to 2 on objects of 850,000 points) and needs no
// memory; both give the same bits.
absl::Status PrepareRadii(const Volume& object, uint64_t searches, DistanceField& distance,
                          const exec::Context& context) {
  if (distance.kind() == DistanceKind::kEuclidean) return absl::OkStatus();
  if (searches <= object.brick_count()) return absl::OkStatus();
  distance = NoDistances(distance.kind());
  BCCSKEL_ASSIGN_OR_RETURN(distance, ComputeDistance(object, DistanceKind::kEuclidean, context));
  return absl::OkStatus();
}

// The stages, in their order, and what they hand to each other.
class Pipeline {
 public:
  // `peeler` may be null: this process peels.
  Pipeline(const SkeletonizeOptions& options, exec::MemoryBudget& memory,
           const exec::Context& context, const OnShellPoints& on_points, const Peeler* peeler)
      : options_(options),
        thinning_(options.thinning),
        memory_(memory),
        context_(context),
        on_points_(on_points),
        peeler_(peeler) {
    result_.options = CanonicalOptions(options);
    result_.options.thinning.keep.clear();
    result_.certificate.sampled = options.source == ObjectSource::kSampledVoxels;
    result_.method = MethodInWords(options.thinning, options.distance, options.source);
    result_.algorithm_version = AlgorithmVersionOf(options.source);
  }

  // The whole object takes the place of the part that is given.
  absl::StatusOr<SkeletonizeResult> RunByPeeler(Volume& given) && {
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
    BCCSKEL_ASSIGN_OR_RETURN(PreparedObject prepared,
                             Prepare(given, options_.preparing, memory_, context_));
    result_.certificate.unprepared = prepared.before;
    result_.preparing = std::move(prepared.steps);
    result_.timings.preparing = clock_.Lap();
    return std::move(prepared.object);
  }

  absl::Status RunFrom(const Volume& object) {
    result_.object_points = object.PointCount();
    if (options_.border == Border::kContinues && !object.empty()) {
      return RunBeyondBorder(object);
    }
    return RunIn(object);
  }

  // All stages work on the shifted object; what they made goes back.
  absl::Status RunBeyondBorder(const Volume& object) {
    // The lattice of an exact conversion has the corners of the image's last voxels, and a cell of
    // points beyond them.
    const BorderPoints last =
        IsConverted(options_.source) ? BorderPoints::kLastCorners : BorderPoints::kLastOfLattice;
    BCCSKEL_ASSIGN_OR_RETURN(ContinuedObject continued,
                             ContinueBeyondBorder(object, last, memory_, context_));
    continued_.emplace(std::move(continued));
    const LatticePoint shift = ShiftOf(continued_->room);
    for (LatticePoint& p : thinning_.keep) p = p + shift;
    extent_ = object.extent();
    BCCSKEL_RETURN_IF_ERROR(RunIn(continued_->object));
    result_.thin = ShiftedBack(result_.thin);
    return absl::OkStatus();
  }

  Volume ShiftedBack(const Volume& volume) const {
    return ShiftedBy(volume, continued_->room, -1, extent_);
  }

  void ShiftGraphBack() {
    const LatticePoint shift = ShiftOf(continued_->room);
    SkeletonGraph& graph = result_.graph;
    for (SkeletonNode& node : graph.nodes) node.at.point = node.at.point - shift;
    for (SkeletonPoint& p : graph.points) p.point = p.point - shift;
    for (SkeletonPoint& p : graph.sheets) p.point = p.point - shift;
  }

  // Where widths and distances are measured.
  const Volume& SpaceOf(const Volume& object) const {
    return continued_.has_value() ? continued_->space : object;
  }

  absl::Status RunIn(const Volume& object) {
    DistanceField distance = NoDistances(options_.distance);
    BCCSKEL_RETURN_IF_ERROR(Thin(object, distance));
    return FinishIn(object, std::move(distance));
  }

  // Those who peel elsewhere keep the distances, so radii are searched for.
  absl::Status PeelAndRun(Volume& object) {
    BCCSKEL_ASSIGN_OR_RETURN(PeeledObject peeled, (*peeler_)(object, thinning_));
    TakeOver(std::move(peeled.thinned));
    result_.object_points = peeled.points;
    result_.certificate.input = peeled.topology;
    return FinishIn(object, NoDistances(DistanceKind::kChamfer));
  }

  absl::Status FinishIn(const Volume& object, DistanceField distance) {
    BCCSKEL_RETURN_IF_ERROR(memory_.TakeFor(result_.thin.PointCount(), kBytesPerThinPoint,
                                            "points that thinning leaves"));
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<float> radii, MeasureAndPrune(object, distance));
    if (peeler_ == nullptr) {
      BCCSKEL_ASSIGN_OR_RETURN(result_.certificate.input, CountBettiNumbers(object, context_));
    }
    BCCSKEL_RETURN_IF_ERROR(Certify(result_.thin, context_, result_.certificate));
    result_.certificate.simple_points_left =
        CountSimplePoints(result_.thin, ThatMayGo(options_),
                          SparedPoints(result_.thin, isthmuses_, thinning_), context_);
    result_.timings.certificate = clock_.Lap();
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<float> stated, StatedRadii(SpaceOf(object), radii));
    BCCSKEL_ASSIGN_OR_RETURN(result_.graph, TraceSkeleton(result_.thin, stated, memory_, context_));
    BCCSKEL_RETURN_IF_ERROR(SetPruningLevels(levels_, context_, result_.graph));
    BCCSKEL_RETURN_IF_ERROR(
        MergeJunctions(result_.options.junction_reach, context_, result_.graph));
    SetBirths(isthmuses_, result_.graph);
    BCCSKEL_RETURN_IF_ERROR(Center(object, distance, radii, stated));
    if (continued_.has_value()) ShiftGraphBack();
    BCCSKEL_ASSIGN_OR_RETURN(result_.sha256, SkeletonDigest(result_.graph, context_));
    result_.timings.graph = clock_.Lap();
    result_.timings.total = clock_.Total();
    return absl::OkStatus();
  }

  // The radii that the result states. By them nodes are chosen and junctions merged, so that
  // whoever has the result can trace what pruning leaves of it (ForEachPrunedGraph()).
  absl::StatusOr<std::vector<float>> StatedRadii(const Volume& space,
                                                 const std::vector<float>& exact) {
    if (!IsConverted(options_.source)) return exact;
    if (!search_.has_value()) search_.emplace(space);
    return MeasureVoxelRadii(space, static_cast<int32_t>(SurfaceStepOf(options_.source)), *search_,
                             result_.thin, exact, context_);
  }

  // Curves are centered in discs as wide as the exact radii.
  absl::Status Center(const Volume& object, const DistanceField& distance,
                      const std::vector<float>& exact, const std::vector<float>& stated) {
    if (options_.distance != DistanceKind::kEuclidean) return absl::OkStatus();
    if (exact != stated) SetRadii(exact, result_.thin, result_.graph);
    BCCSKEL_RETURN_IF_ERROR(CenterCurves(object, distance, context_, result_.graph));
    if (exact != stated) SetRadii(stated, result_.thin, result_.graph);
    return absl::OkStatus();
  }

  // Shells are made of chamfer distances while those are measured, of Euclidean ones depths, too.
  bool NeedsField() const {
    const bool depths = DepthsOf(thinning_.method) == Depths::kWanted;
    return continued_.has_value() || (depths && options_.distance != DistanceKind::kEuclidean);
  }

  absl::StatusOr<DistanceField> MeasureDistances(const Volume& object, DistanceKind kind) {
    if (!continued_.has_value()) return ComputeDistance(object, kind, context_);
    if (kind == DistanceKind::kEuclidean) return std::move(continued_->distance);
    BCCSKEL_ASSIGN_OR_RETURN(const DistanceField field,
                             ComputeDistance(continued_->space, kind, context_));
    return FieldOfPart(object, continued_->space, field);
  }

  absl::Status Thin(const Volume& object, DistanceField& distance) {
    return NeedsField() ? ThinInField(object, distance) : ThinInShells(object, distance);
  }

  absl::Status ThinInField(const Volume& object, DistanceField& distance) {
    BCCSKEL_ASSIGN_OR_RETURN(distance, MeasureDistances(object, options_.distance));
    result_.timings.distance = clock_.Lap();
    BCCSKEL_ASSIGN_OR_RETURN(ThinningResult thinned,
                             ThinObject(object, distance, thinning_, context_, PointsTeller()));
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

  OnShellPoints PointsTeller() const {
    if (!on_points_ || !continued_.has_value()) return on_points_;
    return [this](int32_t shell, const Volume& points) { on_points_(shell, ShiftedBack(points)); };
  }

  void TakeOver(ThinningResult thinned) {
    result_.thin = std::move(thinned.thin);
    result_.last_shell = thinned.last_shell;
    result_.timings.shells = thinned.times.shells;
    result_.timings.thinning = thinned.times.passes;
    result_.timings.cleanup = thinned.times.cleanup;
    isthmuses_ = std::move(thinned.isthmuses);
    clock_.Lap();
  }

  // Returns the radii of the points that stay.
  absl::StatusOr<std::vector<float>> MeasureAndPrune(const Volume& object,
                                                     DistanceField& distance) {
    if (peeler_ == nullptr && !continued_.has_value()) {
      const uint64_t searches =
          result_.thin.PointCount() *
          (options_.distance == DistanceKind::kEuclidean ? kMostDistancesOfPoint : 1);
      BCCSKEL_RETURN_IF_ERROR(PrepareRadii(object, searches, distance, context_));
    } else if (peeler_ == nullptr && distance.kind() != DistanceKind::kEuclidean) {
      distance = std::move(continued_->distance);
    }
    const ExactRadius radius(object, distance);
    BCCSKEL_ASSIGN_OR_RETURN(std::vector<float> radii, ExactRadii(result_.thin, radius, context_));
    if (IsConverted(options_.source) && !continued_.has_value()) search_.emplace(object);
    if (HasCurves(options_.thinning)) {
      const ExactRadius& single = search_.has_value() ? *search_ : radius;
      BCCSKEL_RETURN_IF_ERROR(PruneCurves(object, single, radii));
    }
    if (HasSheets(options_.thinning)) BCCSKEL_RETURN_IF_ERROR(PruneSurface(radii));
    result_.skeleton_points = result_.thin.PointCount();
    result_.timings.pruning = clock_.Lap();
    return radii;
  }

  absl::Status PruneCurves(const Volume& object, const ExactRadius& radius,
                           std::vector<float>& radii) {
    std::vector<int32_t> births;
    if (options_.thinning.kind == SkeletonKind::kIsthmusCurve) {
      births = BirthsOf(result_.thin, isthmuses_);
    }
    BCCSKEL_ASSIGN_OR_RETURN(
        PrunedSkeleton pruned,
        Prune({result_.thin, radii, births, SurfaceStepOf(options_.source), &SpaceOf(object)},
              object, radius, thinning_.keep, options_.pruning, context_));
    TakeOver(std::move(pruned.thin), std::move(pruned.radii), radii);
    levels_ = std::move(pruned.levels);
    return absl::OkStatus();
  }

  absl::Status PruneSurface(std::vector<float>& radii) {
    const PruningOptions& pruning = result_.options.pruning;
    if (pruning.rule == PruningRule::kNone) return absl::OkStatus();
    const std::vector<int32_t> births = BirthsOf(result_.thin, isthmuses_);
    BCCSKEL_ASSIGN_OR_RETURN(
        PrunedSheets pruned,
        PruneSheets({result_.thin, radii, births}, pruning.threshold, thinning_.keep, context_));
    TakeOver(std::move(pruned.thin), std::move(pruned.radii), radii);
    return absl::OkStatus();
  }

  void TakeOver(Volume thin, std::vector<float> new_radii, std::vector<float>& radii) {
    if (on_points_) PointsTeller()(result_.last_shell + 1, PointsOnlyIn(result_.thin, thin));
    result_.thin = std::move(thin);
    radii = std::move(new_radii);
  }

  const SkeletonizeOptions& options_;
  ThinningOptions thinning_;  // the points to keep where the object is
  exec::MemoryBudget& memory_;
  const exec::Context& context_;
  const OnShellPoints& on_points_;
  const Peeler* const peeler_;
  exec::StageClock clock_;
  std::vector<IsthmusBirth> isthmuses_;
  PruningLevels levels_;
  std::optional<ContinuedObject> continued_;
  std::optional<ExactRadius> search_;  // where radii of voxels are measured
  LatticeExtent extent_;               // of the object as it was given, where that is continued
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
  if (options.border != Border::kEnds) {
    return absl::InvalidArgumentError("an object that is peeled elsewhere must end at its border");
  }
  exec::MachineMemory memory;
  return Pipeline(options, memory, context, nullptr, &peeler).RunByPeeler(object);
}

}  // namespace bccskel
