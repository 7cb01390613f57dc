#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/cli/job_calls.h"
#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"
#include "client/cli/thinning_options.h"
#include "client/export/atomic_file.h"
#include "client/export/skeleton_file.h"
#include "client/skeletonize_client.h"
#include "client/view/display_surface.h"
#include "client/view/render/subject_picture.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/mesh_file.h"
#include "core/io/volume_file.h"
#include "core/labels/convert_label.h"
#include "core/labels/edge_image.h"
#include "core/labels/nrrd_writer.h"
#include "core/pipeline/notes.h"
#include "core/pipeline/skeletonize.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Collects the points removed with each shell while a job runs, here or on a server.
class ShellCollector {
 public:
  // `object` must outlive the collector.
  explicit ShellCollector(const Volume& object) : object_(object) {}

  void Add(int32_t shell, std::span<const LatticePoint> points) {
    // A retried call reports all shells again.
    if (shell < last_) shells_.clear();
    last_ = shell;
    const auto [at, is_new] =
        shells_.try_emplace(shell, VolumeBuilder(object_.extent(), object_.placement()));
    for (LatticePoint p : points) at->second.Add(p);
  }

  view::PeeledShells Take() && {
    view::PeeledShells shells;
    for (auto& [shell, builder] : shells_) {
      if (auto points = std::move(builder).Build(); points.ok()) shells[shell] = *std::move(points);
    }
    return shells;
  }

 private:
  const Volume& object_;
  int32_t last_ = 0;
  std::map<int32_t, VolumeBuilder> shells_;
};

namespace {

using Clock = std::chrono::steady_clock;

// The object to thin and the mesh or image that it was made from, if any.
struct Object {
  Volume volume;
  std::optional<MeshStage> mesh = std::nullopt;
  std::optional<ImageStage> image = std::nullopt;
  std::optional<LabeledObjects> voxels = std::nullopt;  // if images are requested
};

absl::StatusOr<Object> FromMesh(const SkeletonizeArguments& arguments,
                                const exec::Context& context) {
  if (arguments.part.index > 0) return Object();
  BCCSKEL_ASSIGN_OR_RETURN(VoxelizeResult result,
                           VoxelizeFile(arguments.input, arguments.grid, context));
  for (const std::string& warning : result.warnings) Warn(arguments.input + ": " + warning);
  return Object{std::move(result.volume), MeshStageOf(result)};
}

absl::StatusOr<Object> FromVolume(const SkeletonizeArguments& arguments,
                                  const exec::Context& context) {
  VolumeLimits limits;
  if (arguments.part.count > 1) limits.max_bricks = limits.max_decoded_bytes = ~uint64_t{0};
  BCCSKEL_ASSIGN_OR_RETURN(Volume volume,
                           ReadVolumePart(arguments.input, arguments.part, limits, context));
  return Object{std::move(volume)};
}

absl::StatusOr<Object> FromImage(const SkeletonizeArguments& arguments,
                                 const exec::Context& context) {
  const bool draws = arguments.images.wanted() && arguments.part.index == 0;
  const KeptVoxels kept = draws ? KeptVoxels::kAll : KeptVoxels::kNone;
  ImageArguments image = arguments.image;
  image.mask.part = arguments.part;
  BCCSKEL_ASSIGN_OR_RETURN(ImageObject object,
                           ConvertImageFile(arguments.input, image, kept, context));
  return Object{std::move(object.volume), std::nullopt, std::move(object.image),
                std::move(object.voxels)};
}

absl::StatusOr<Object> Load(const SkeletonizeArguments& arguments, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const InputKind kind, InputKindOf(arguments.input, arguments.image));
  if (kind == InputKind::kVolume) return FromVolume(arguments, context);
  if (arguments.accepted == AcceptedInput::kVolumeOnly) {
    return absl::InvalidArgumentError(
        arguments.input + ": submit takes volumes; skeletonize takes meshes and images, too");
  }
  return kind == InputKind::kMesh ? FromMesh(arguments, context) : FromImage(arguments, context);
}

absl::StatusOr<Object> LoadOrMake(const SkeletonizeArguments& arguments, const SharedWork& work,
                                  const exec::Context& context) {
  if (!work.make) return Load(arguments, context);
  BCCSKEL_ASSIGN_OR_RETURN(Volume volume, work.make(context));
  return Object{std::move(volume)};
}

bool Wants(const SkeletonizeArguments& arguments, exporting::SkeletonFormat wanted) {
  return std::ranges::any_of(arguments.outputs, [&](const std::string& path) {
    const auto format = exporting::SkeletonFormatOf(path);
    return format.ok() && *format == wanted;
  });
}

// Listeners of a running job.
struct Listeners {
  Listeners(const SkeletonizeArguments& arguments, const Volume& object, ProgressBar& progress)
      : bar(progress) {
    // If thinning stops early, the rest is not a skeleton, and the shells do not contain it. Shells
    // of a prepared object do not fit the original.
    const bool whole =
        arguments.skeletonize.thinning.last_shell == 0 && !arguments.skeletonize.preparing.Wanted();
    if (whole && Wants(arguments, exporting::SkeletonFormat::kHtml)) shells.emplace(object);
  }

  ProgressBar& bar;
  std::optional<ShellCollector> shells;  // for a page, which shows the object being peeled
};

absl::StatusOr<SkeletonizeResult> OnServer(const SkeletonizeArguments& arguments,
                                           const Volume& object, Listeners& listeners,
                                           const std::stop_token& stop) {
  client::CallOptions options;
  options.skeletonize = arguments.skeletonize;
  options.threads = arguments.common.threads;
  options.thin_volume = Wants(arguments, exporting::SkeletonFormat::kVolume)
                            ? client::ThinVolume::kReturn
                            : client::ThinVolume::kOmit;
  options.timeout = arguments.timeout;
  options.stop = stop;
  options.on_shell = listeners.bar.Callback("waiting for the server");
  std::string lost;
  options.on_lost = [&](const std::string& job) {
    lost = job;
    Warn("lost the connection to " + arguments.server.address + "; waiting for the server, up to " +
         "two minutes, to go on with " + job);
  };
  if (listeners.shells.has_value()) {
    options.on_shell_points = [&](int32_t shell, std::span<const LatticePoint> points) {
      listeners.shells->Add(shell, points);
    };
  }
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(arguments.server));
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<client::Stub> stub, client::MakeGrpcStub(endpoint));
  absl::StatusOr<SkeletonizeResult> result =
      client::SkeletonizeClient(std::move(stub)).Skeletonize(object, options);
  if (!absl::IsUnavailable(result.status()) || lost.empty()) return result;
  return absl::UnavailableError(absl::StrCat(
      result.status().message(), "; once the server is back, `bccskel fetch ", lost, " -o FILE ",
      "--server ", arguments.server.address, "` gets the result if all of the object was sent"));
}

absl::StatusOr<SkeletonizeResult> OnThisMachine(const SkeletonizeArguments& arguments,
                                                Volume& object, Listeners& listeners,
                                                exec::Context context, const SharedWork& work) {
  context.deadline = Clock::now() + arguments.timeout;
  context.on_shell = listeners.bar.Callback("measuring distances");
  if (work.compute) return work.compute(object, arguments.skeletonize, context);
  OnShellPoints on_points;
  if (listeners.shells.has_value()) {
    on_points = [&](int32_t shell, const Volume& points) {
      listeners.shells->Add(shell, points.SortedPoints());
    };
  }
  return Skeletonize(object, arguments.skeletonize, context, on_points);
}

struct Computed {
  SkeletonizeResult result;
  std::optional<view::PeeledShells> shells;
};

absl::StatusOr<Computed> Compute(const SkeletonizeArguments& arguments, Volume& object,
                                 const exec::Context& context, const SharedWork& work,
                                 ProgressBar& bar) {
  Listeners listeners(arguments, object, bar);
  const bool local = arguments.place != Place::kServer;
  BCCSKEL_ASSIGN_OR_RETURN(SkeletonizeResult result,
                           local ? OnThisMachine(arguments, object, listeners, context, work)
                                 : OnServer(arguments, object, listeners, context.stop));
  Computed computed = {std::move(result), std::nullopt};
  if (listeners.shells.has_value()) computed.shells = std::move(*listeners.shells).Take();
  return computed;
}

// Adds the image's own topology to the certificate.
absl::Status CertifyImage(const SkeletonizeArguments& arguments, const Object& object,
                          Certificate& certificate) {
  if (!object.image.has_value()) return absl::OkStatus();
  certificate.mask = object.image->mask;
  if (certificate.sampled) return absl::OkStatus();  // a note tells changes
  return CheckConversion(arguments.input, arguments.image, object.image->mask, certificate.Given());
}

// Called after thinning, because the nodes must be known.
absl::Status CheckRoot(const SkeletonizeArguments& arguments, const SkeletonGraph& graph) {
  if (!arguments.root.has_value()) return absl::OkStatus();
  const std::string outside = RootWarning(*arguments.root, graph);
  if (!outside.empty()) Warn(arguments.input + ": " + outside);
  return CheckRootChoice(*arguments.root, graph);
}

exporting::World WorldOfInput(const Object& object, const std::string& input) {
  if (object.image.has_value()) return WorldOf(object.image->info);
  return IsGltfPath(input) ? exporting::World{.axes = exporting::kYUp, .unit = {}}
                           : exporting::World();
}

// Writes the images of the skeleton and adds them to the files.
absl::Status WriteImages(const SkeletonizeArguments& arguments, const Object& object,
                         const SkeletonGraph& graph, const exec::Context& context,
                         std::vector<WrittenFile>& files) {
  const SkeletonImages& images = arguments.images;
  if (!images.wanted()) return absl::OkStatus();
  const MaskGrid& grid = object.voxels->grid;
  const auto write = [&](const std::string& path, const SparseImage& image,
                         const char* note) -> absl::Status {
    const ImageInfo& info = object.image->info;
    BCCSKEL_ASSIGN_OR_RETURN(const std::string bytes,
                             NrrdBytes(grid, {info.world, info.unit}, image));
    BCCSKEL_RETURN_IF_ERROR(exporting::WriteFileAtomically(path, bytes, context.stop));
    files.push_back({path, note});
    return absl::OkStatus();
  };
  static const LabeledObject kNone = {};
  const auto& objects = object.voxels->objects;
  const LabeledObject& voxels = objects.empty() ? kNone : objects.front();
  if (!images.branches.empty()) {
    BCCSKEL_ASSIGN_OR_RETURN(
        const SparseImage branches,
        NearestEdges(grid, voxels, graph, arguments.image.mask.adjacency, context));
    BCCSKEL_RETURN_IF_ERROR(write(images.branches, branches,
                                  "every voxel's nearest branch: its index in the graph + 1"));
  }
  if (images.curves.empty()) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const SparseImage curves, DrawSkeleton(grid, voxels, graph));
  return write(images.curves, curves, "the voxels of each branch: its index in the graph + 1");
}

struct Written {
  std::vector<WrittenFile> files;
  ExitCode code = ExitCode::kOk;

  // Goes on after a file that cannot be written: a full disk must not cost the work for the others.
  void Add(const std::string& path, absl::StatusOr<std::string> note) {
    if (note.ok()) files.push_back({path, *std::move(note)});
    if (!note.ok()) code = FailWith(ExitCode::kOutput, note.status());
  }
};

absl::StatusOr<Written> WriteOutputs(const SkeletonizeArguments& arguments, const Object& object,
                                     const Computed& computed, const exec::Context& context,
                                     const ProgressBar& bar) {
  const exporting::Subject subject = {computed.result,
                                      object.volume,
                                      std::string(FileName(arguments.input)),
                                      context,
                                      computed.shells.has_value() ? &*computed.shells : nullptr,
                                      arguments.root,
                                      WorldOfInput(object, arguments.input),
                                      arguments.swc,
                                      view::DrawSubject};
  Written written;
  for (const std::string& path : arguments.outputs) {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    bar.Begin("writing", path);
    absl::StatusOr<std::string> note = exporting::WriteSkeletonFile(path, subject);
    const bool of_all = absl::IsInvalidArgument(note.status()) || absl::IsCancelled(note.status());
    if (of_all) return note.status();
    written.Add(path, std::move(note));
  }
  if (arguments.images.wanted()) bar.Begin("writing images");
  const absl::Status drawn =
      WriteImages(arguments, object, computed.result.graph, context, written.files);
  if (absl::IsCancelled(drawn)) return drawn;
  if (!drawn.ok()) written.code = FailWith(ExitCode::kOutput, drawn);
  return written;
}

// The only INVALID_ARGUMENT of writing is an object with coordinates that no format can hold.
ExitCode FailWriting(const SkeletonizeArguments& arguments, const absl::Status& error) {
  if (!absl::IsInvalidArgument(error)) return FailWith(ExitCode::kOutput, error);
  return Fail(absl::InvalidArgumentError(arguments.input + ": " + std::string(error.message())));
}

ExitCode PrintSummary(const SkeletonSummary& summary) {
  const bool json = summary.arguments.common.summary == SummaryStyle::kJson;
  return Print(json ? SkeletonSummaryJson(summary) : SkeletonSummaryText(summary));
}

// Takes into account that an image's object has a surface in steps of a voxel.
SkeletonizeArguments ForInput(SkeletonizeArguments arguments, const Object& object) {
  if (object.image.has_value()) {
    const MaskGrid grid = GridOf(object.image->info);
    arguments.skeletonize = ForMask(arguments.skeletonize, grid, arguments.image.mask);
  }
  return arguments;
}

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void AddSubmit(CLI::App& command, SkeletonizeArguments& arguments) {
  arguments.accepted = AcceptedInput::kVolumeOnly;
  AddInput(command, "VOLUME", arguments.input, "Volume file, .exr or .bccb");
  AddOutputs(command, arguments.outputs)
      ->required(false)
      ->option_text("FILE (required unless detached)");
  AddSwcStep(command, arguments.swc);
  AddServer(command, arguments.server);
  command.add_flag_callback(
      "--detach", [&arguments] { arguments.waiting = Waiting::kDetach; },
      "Print the job's name and exit; the server keeps the job (see fetch)");
  command.add_flag_callback(
      "--thin-volume", [&arguments] { arguments.thin_volume = client::ThinVolume::kReturn; },
      "With --detach: also keep the thinned volume, so that fetch can write it");
  AddComputing(command, arguments);
}

void AddSkeletonize(CLI::App& command, SkeletonizeArguments& arguments) {
  AddInput(command, "INPUT", arguments.input, "Mesh, volume or image file");
  AddOutputs(command, arguments.outputs);
  AddSwcStep(command, arguments.swc);
  AddGrid(command, arguments.grid);
  AddImage(command, arguments.image);
  AddSkeletonImages(command, arguments.images);
  AddPlace(command, arguments.server, arguments.place);
  AddComputing(command, arguments);
}

absl::StatusOr<Volume> LoadPart(const SkeletonizeArguments& arguments,
                                const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(Object object, Load(arguments, context));
  return std::move(object.volume);
}

ExitCode RunShared(const SharedWork& work, const SkeletonizeArguments& given,
                   const std::stop_token& stop) {
  const Clock::time_point start = Clock::now();
  LocalTeam team(given.common.threads, stop);
  ProgressBar bar(given.common.progress);
  bar.Begin("reading", given.input);
  absl::StatusOr<Object> object = LoadOrMake(given, work, team.context());
  if (!object.ok()) return Fail(object.status());
  const SkeletonizeArguments arguments = ForInput(given, *object);
  if (arguments.waiting == Waiting::kDetach) {
    return SubmitDetached(arguments, object->volume, stop);
  }
  absl::StatusOr<Computed> computed = Compute(arguments, object->volume, team.context(), work, bar);
  if (!computed.ok()) return FailComputing(arguments, computed.status(), LocalCommand(arguments));
  SkeletonizeResult* const result = &computed->result;
  const absl::Status rooted = CheckRoot(arguments, result->graph);
  if (!rooted.ok()) return FailWith(ExitCode::kUsage, rooted);
  const absl::Status kept = CertifyImage(arguments, *object, result->certificate);
  if (!kept.ok()) return Fail(kept);
  for (const std::string& note : NotesOn(*result)) Warn(arguments.input + ": " + note);
  absl::StatusOr<Written> written =
      WriteOutputs(arguments, *object, *computed, team.context(), bar);
  if (!written.ok()) return FailWriting(arguments, written.status());
  const ExitCode printed =
      PrintSummary({arguments, object->volume, *result, object->mesh, object->image,
                    std::move(written->files), SecondsSince(start)});
  if (!result->certificate.TopologyKept()) return ExitCode::kInternal;
  return written->code == ExitCode::kOk ? printed : written->code;
}

ExitCode Run(const SkeletonizeArguments& arguments, const std::stop_token& stop) {
  return RunShared({}, arguments, stop);
}

}  // namespace bccskel::cli
