#include "client/python/native/compute.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/load_object.h"
#include "client/view/result_graph.h"
#include "core/exec/status_macros.h"
#include "core/import/voxelize/voxelize.h"
#include "core/labels/convert_label.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel::python {
namespace {

// The threads of one call on this machine, which also converts the input for a server.
class Here {
 public:
  explicit Here(const Run& run) : team_(run.threads, run.stop) {
    team_.context().deadline = exec::Context::Clock::now() + run.timeout;
  }
  exec::Context& context() { return team_.context(); }

 private:
  cli::LocalTeam team_;
};

std::function<void(const exec::ShellProgress&)> OnShell(const Run& run) {
  return [&run](const exec::ShellProgress& shell) {
    if (run.on_progress) {
      run.on_progress(static_cast<uint64_t>(shell.shell), static_cast<uint64_t>(shell.last_shell));
    }
  };
}

absl::StatusOr<SkeletonizeResult> Compute(const Volume& object, const SkeletonizeOptions& options,
                                          const Run& run, exec::Context context) {
  if (run.server == nullptr) {
    context.on_shell = OnShell(run);
    return Skeletonize(object, options, context);
  }
  client::CallOptions call;
  call.skeletonize = options;
  call.threads = run.threads;
  call.thin_volume = client::ThinVolume::kReturn;
  call.timeout = run.timeout;
  call.stop = run.stop;
  call.on_shell = OnShell(run);
  return run.server->Skeletonize(object, call);
}

absl::StatusOr<Outcome> OutcomeOf(Volume object, const SkeletonizeOptions& options,
                                  const std::optional<RootChoice>& root, const Run& run,
                                  const exec::Context& context) {
  Outcome outcome;
  BCCSKEL_ASSIGN_OR_RETURN(outcome.result, Compute(object, options, run, context));
  outcome.root = root;
  if (root.has_value()) {
    BCCSKEL_RETURN_IF_ERROR(CheckRootChoice(*root, outcome.result.graph));
    std::string warning = RootWarning(*root, outcome.result.graph);
    if (!warning.empty()) outcome.warnings.push_back(std::move(warning));
  }
  outcome.object = std::make_shared<const Volume>(std::move(object));
  return outcome;
}

// Adds the mask's own topology to the certificate, and notes on it to the warnings.
absl::Status Certify(const cli::ImageStage& image, const MaskOptions& options, Outcome& outcome) {
  Certificate& certificate = outcome.result.certificate;
  certificate.mask = image.mask;
  outcome.warnings.insert(outcome.warnings.end(), image.warnings.begin(), image.warnings.end());
  const std::string changes = DescribeChanges(image.mask, certificate.Given());
  if (changes.empty() || options.sampling.has_value()) return absl::OkStatus();
  return absl::InternalError("the conversion to the lattice changed " + changes);
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Volume>> Outcome::Object() const {
  if (object != nullptr) return object;
  if (label == nullptr || !grid.has_value()) {
    return absl::UnimplementedError(
        "pictures and pages also show the object: for a label that a server has computed, use "
        "skeletonize(image == label)");
  }
  BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask made, ConvertLabel(*grid, *label, mask, {}));
  return std::make_shared<const Volume>(std::move(made.volume));
}

absl::StatusOr<Outcome> SkeletonizeMask(const ArraySource& array,
                                        const cli::SkeletonizeArguments& arguments,
                                        const Run& run) {
  Here here(run);
  const MaskOptions& options = arguments.image.mask;
  ArraySource mask = array;
  BCCSKEL_ASSIGN_OR_RETURN(
      cli::ImageObject image,
      cli::ConvertImage(mask, arguments.image, cli::KeptVoxels::kNone, here.context()));
  if (image.image.voxels == 0 && !arguments.image.labels.empty()) {
    mask = array;
    return cli::NoSuchLabel(arguments.image.labels, mask);
  }
  const MaskGrid grid = cli::GridOf(mask.info());
  BCCSKEL_ASSIGN_OR_RETURN(Outcome outcome, OutcomeOf(std::move(image.volume),
                                                      ForMask(arguments.skeletonize, grid, options),
                                                      arguments.root, run, here.context()));
  outcome.voxels = image.image.voxels;
  outcome.grid = grid;
  outcome.mask = options;
  BCCSKEL_RETURN_IF_ERROR(Certify(image.image, options, outcome));
  return outcome;
}

absl::StatusOr<Outcome> SkeletonizeMesh(const TriangleMesh& mesh,
                                        const cli::SkeletonizeArguments& arguments,
                                        const Run& run) {
  if (arguments.skeletonize.border == Border::kContinues) {
    return absl::InvalidArgumentError("border is for images and volumes, not for a mesh");
  }
  Here here(run);
  VoxelizeOptions grid = arguments.grid;
  if (!grid.points.has_value() && !grid.spacing.has_value()) grid.points = cli::kDefaultPoints;
  BCCSKEL_ASSIGN_OR_RETURN(VoxelizeResult filled, Voxelize(mesh, grid, here.context()));
  BCCSKEL_ASSIGN_OR_RETURN(
      Outcome outcome, OutcomeOf(std::move(filled.volume), arguments.skeletonize, arguments.root,
                                 run, here.context()));
  for (std::string& warning : filled.warnings) outcome.warnings.push_back(std::move(warning));
  return outcome;
}

absl::StatusOr<Outcome> SkeletonizeVolume(const Volume& object,
                                          const cli::SkeletonizeArguments& arguments,
                                          const Run& run) {
  Here here(run);
  return OutcomeOf(object, arguments.skeletonize, arguments.root, run, here.context());
}

absl::StatusOr<LabelOutcomes> SkeletonizeImage(const ArraySource& array,
                                               const cli::LabelsArguments& arguments,
                                               const Run& run) {
  Here here(run);
  const MaskOptions options = arguments.image.mask;
  ArraySource image = array;
  BCCSKEL_ASSIGN_OR_RETURN(
      cli::CollectedLabels collected,
      cli::CollectLabels(image, arguments.image, arguments.min_voxels, here.context()));
  const auto labels = std::make_shared<const LabeledObjects>(std::move(collected.objects));
  if (labels->objects.empty() && collected.left_out == 0 && !arguments.image.labels.empty()) {
    image = array;
    return cli::NoSuchLabel(arguments.image.labels, image);
  }
  LabelOutcomes outcomes;
  const auto take = [&](LabelSkeleton&& skeleton) {
    const auto outcome = std::make_shared<Outcome>();
    outcome->result = std::move(skeleton.result);
    outcome->root = arguments.root;
    outcome->voxels = skeleton.voxels;
    outcome->grid = labels->grid;
    outcome->mask = options;
    outcome->label = {labels, &labels->objects[outcomes.size()]};
    outcomes.emplace(skeleton.label, outcome);
    if (run.on_progress) run.on_progress(outcomes.size(), labels->objects.size());
    return absl::OkStatus();
  };
  BCCSKEL_RETURN_IF_ERROR(SkeletonizeLabels(
      *labels, {.mask = options, .skeleton = arguments.skeletonize}, take, here.context()));
  return outcomes;
}

absl::StatusOr<LabelOutcomes> SkeletonizeOnServer(const ArraySource& array,
                                                  const client::LabelVolume& image,
                                                  const cli::LabelsArguments& arguments,
                                                  const Run& run) {
  if (arguments.image.mask.sampling.has_value()) {
    return absl::UnimplementedError("servers convert labels exactly: omit sampling");
  }
  client::LabelsCallOptions call;
  call.skeletonize = arguments.skeletonize;
  call.adjacency = arguments.image.mask.adjacency;
  call.points = arguments.image.mask.points;
  call.labels = arguments.image.labels;
  call.min_voxels = arguments.min_voxels;
  call.threads = run.threads;
  call.timeout = run.timeout;
  call.stop = run.stop;
  call.on_progress = run.on_progress;
  LabelOutcomes outcomes;
  const auto take = [&](LabelSkeleton&& skeleton) {
    const auto outcome = std::make_shared<Outcome>();
    outcome->result = std::move(skeleton.result);
    outcome->root = arguments.root;
    outcome->voxels = skeleton.voxels;
    outcome->grid = image.grid;
    outcomes.emplace(skeleton.label, outcome);
    return absl::OkStatus();
  };
  BCCSKEL_ASSIGN_OR_RETURN(const client::LabelsReport report,
                           run.server->SkeletonizeLabels(image, call, take));
  if (outcomes.empty() && report.skipped == 0 && !call.labels.empty()) {
    ArraySource source = array;
    return cli::NoSuchLabel(call.labels, source);
  }
  return outcomes;
}

absl::StatusOr<Outcome> ReadResult(const std::string& path, const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const view::ResultDocument document,
                           view::ReadResultDocument(path, stop));
  absl::StatusOr<view::ResultGraph> found = view::ResultGraphOf(document, stop);
  if (!found.ok()) {
    return absl::Status(found.status().code(),
                        absl::StrCat(path, ": ", std::string(found.status().message())));
  }
  view::ResultGraph& read = *found;
  Outcome outcome;
  outcome.document = document.text;
  outcome.result.graph = std::move(read.graph);
  outcome.result.certificate = read.certificate;
  outcome.result.preparing = read.steps;
  outcome.result.object_points = read.object_points;
  outcome.result.method = read.method;
  outcome.result.algorithm_version = read.algorithm_version;
  BCCSKEL_ASSIGN_OR_RETURN(outcome.result.sha256, SkeletonDigest(outcome.result.graph));
  outcome.root = read.root;
  outcome.read = std::move(read);
  return outcome;
}

}  // namespace bccskel::python
