#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/load_object.h"
#include "client/cli/thinning_options.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"

// What is wrong with arguments of which each alone is right.

namespace bccskel::cli {
namespace {

using Complaint = std::optional<std::string>;

Complaint IfError(const absl::Status& status) {
  if (status.ok()) return std::nullopt;
  return std::string(status.message());
}

Complaint VolumeOutputComplaint(const std::string& path) {
  const absl::StatusOr<exporting::SkeletonFormat> format = exporting::SkeletonFormatOf(path);
  if (format.ok() && *format == exporting::SkeletonFormat::kVolume) return std::nullopt;
  return path + ": a volume file ends in .exr or .bccb";
}

// Writing over the input would destroy what cannot be computed again.
Complaint OverwriteComplaint(const std::string& input, const std::string& output) {
  std::error_code none;
  if (!std::filesystem::equivalent(input, output, none)) return std::nullopt;
  return output + ": is the input, too, and would be overwritten";
}

// Options that say how to make an object are for one kind of input each.
Complaint ObjectComplaint(const std::string& input, const VoxelizeOptions& grid,
                          const ImageArguments& image) {
  if (Complaint c = IfError(ForegroundOf(image).status()); c.has_value()) return c;
  const absl::StatusOr<InputKind> kind = InputKindOf(input, image);
  if (!kind.ok()) return std::nullopt;
  const std::string is = "; " + input + " is " + std::string(InputKindPhrase(*kind));
  const bool grid_given =
      grid.points.has_value() || grid.spacing.has_value() || grid.fill != FillRule::kAuto;
  if (grid_given && *kind != InputKind::kMesh) {
    return "--points, --spacing and --fill are for meshes" + is;
  }
  if (!image.given || *kind == InputKind::kImage) return std::nullopt;
  return "--label, --range, --threshold and the like are for images" + is;
}

Complaint ImagesComplaint(const SkeletonizeArguments& arguments) {
  if (!arguments.images.wanted()) return std::nullopt;
  for (const std::string& path : {arguments.images.branches, arguments.images.curves}) {
    if (!path.empty() && !path.ends_with(".nrrd")) return path + ": does not end in .nrrd";
    if (Complaint c = OverwriteComplaint(arguments.input, path); c.has_value()) return c;
  }
  if (arguments.skeletonize.preparing.Wanted()) {
    return "--branch-image and --curve-image show the voxels as they are, so not with --denoise, "
           "--fill-cavities, --cut-loops, --min-component, --min-component-volume or "
           "--keep-largest";
  }
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.input, arguments.image);
  if (!kind.ok() || *kind == InputKind::kImage) return std::nullopt;
  return "--branch-image and --curve-image are for images; " + arguments.input + " is " +
         std::string(InputKindPhrase(*kind));
}

Complaint ComplaintAbout(const SkeletonizeArguments& arguments) {
  const bool detached = arguments.waiting == Waiting::kDetach;
  if (!detached && arguments.outputs.empty()) return "--output is required";
  if (detached && !arguments.outputs.empty()) {
    return "--detach writes no files; bccskel fetch does, when the job has ended";
  }
  if (!detached && arguments.thin_volume == client::ThinVolume::kReturn) {
    return "--thin-volume is for --detach; without it -o FILE.exr or FILE.bccb asks for the volume";
  }
  for (const std::string& output : arguments.outputs) {
    if (Complaint c = IfError(exporting::SkeletonFormatOf(output).status()); c.has_value())
      return c;
    if (Complaint c = OverwriteComplaint(arguments.input, output); c.has_value()) return c;
  }
  if (Complaint c = ObjectComplaint(arguments.input, arguments.grid, arguments.image);
      c.has_value()) {
    return c;
  }
  if (Complaint c = ImagesComplaint(arguments); c.has_value()) return c;
  return ComplaintAboutOptions(arguments.skeletonize);
}

Complaint ComplaintAbout(const VoxelizeArguments& arguments) {
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.input, arguments.image);
  const bool sized = arguments.grid.points.has_value() || arguments.grid.spacing.has_value();
  if (!sized && kind.ok() && *kind == InputKind::kMesh) {
    return "voxelize needs --points or --spacing for a mesh";
  }
  if (Complaint c = VolumeOutputComplaint(arguments.output); c.has_value()) return c;
  return ObjectComplaint(arguments.input, arguments.grid, arguments.image);
}

Complaint ComplaintAbout(const GenerateArguments& arguments) {
  return VolumeOutputComplaint(arguments.output);
}

Complaint ResultComplaint(const ResultArguments& source, const std::string& output) {
  for (const std::string& input : {source.result, source.object}) {
    if (Complaint c = OverwriteComplaint(input, output); c.has_value()) return c;
  }
  return ObjectComplaint(source.object, source.grid, source.image);
}

Complaint ComplaintAbout(const ViewArguments& arguments) {
  return ResultComplaint(arguments.source, arguments.output);
}
Complaint ComplaintAbout(const RenderArguments& arguments) {
  return ResultComplaint(arguments.source, arguments.output);
}
Complaint ComplaintAbout(const ReconstructArguments& arguments) {
  return ResultComplaint(arguments.source, arguments.output);
}
Complaint ComplaintAbout(const LabelsArguments& arguments) {
  const bool on_server = arguments.place == Place::kServer;
  if (on_server && arguments.image.mask.sampling.has_value()) {
    return "--sampling is for this machine; a server converts labels exactly";
  }
  for (const std::string& output : arguments.outputs) {
    if (Complaint c = IfError(CheckLabelOutput(output)); c.has_value()) return c;
    if (on_server &&
        exporting::SkeletonFormatOf(output).value() == exporting::SkeletonFormat::kVolume) {
      return output + ": a server returns no thinned volumes of labels; compute here with --local";
    }
    if (Complaint c = OverwriteComplaint(arguments.input, output); c.has_value()) return c;
  }
  if (Complaint c = ComplaintAboutRootOfLabels(arguments.root); c.has_value()) return c;
  return ComplaintAboutOptions(arguments.skeletonize);
}

Complaint FetchComplaint(const std::string& object, const std::string& output) {
  using exporting::SkeletonFormat;
  const absl::StatusOr<SkeletonFormat> format = exporting::SkeletonFormatOf(output);
  if (!format.ok()) return IfError(format.status());
  const bool shows_object = *format == SkeletonFormat::kSvg || *format == SkeletonFormat::kHtml;
  if (shows_object && object.empty()) {
    return output + ": shows the object, too: name the volume that was submitted with --object";
  }
  return OverwriteComplaint(object, output);
}

Complaint ComplaintAbout(const FetchArguments& arguments) {
  for (const std::string& output : arguments.outputs) {
    if (Complaint c = FetchComplaint(arguments.object, output); c.has_value()) return c;
  }
  return arguments.object.empty() ? std::nullopt : VolumeOutputComplaint(arguments.object);
}

Complaint ComplaintAbout(const InfoArguments& arguments) {
  return ObjectComplaint(arguments.file, {}, arguments.image);
}

template <typename Other>
Complaint ComplaintAbout(const Other&) {
  return std::nullopt;
}

}  // namespace

std::optional<std::string> ComplaintAbout(const Arguments& arguments) {
  return std::visit([](const auto& chosen) { return ComplaintAbout(chosen); }, arguments);
}

namespace {

template <typename Chosen>
std::vector<std::string> OutputsOf(const Chosen& arguments) {
  std::vector<std::string> paths;
  if constexpr (requires { arguments.outputs; }) paths = arguments.outputs;
  if constexpr (requires { arguments.output; }) paths.push_back(arguments.output);
  if constexpr (requires { arguments.images; }) {
    for (const std::string& path : {arguments.images.branches, arguments.images.curves}) {
      if (!path.empty()) paths.push_back(path);
    }
  }
  return paths;
}

}  // namespace

absl::Status CheckOutputs(const Arguments& arguments) {
  const std::vector<std::string> paths =
      std::visit([](const auto& chosen) { return OutputsOf(chosen); }, arguments);
  for (const std::string& path : paths) {
    // Which folders a label's number names is not known yet.
    if (path.rfind('/') != path.npos && path.find(kLabelPlace) < path.rfind('/')) continue;
    BCCSKEL_RETURN_IF_ERROR(exporting::CheckOutput(path));
  }
  return absl::OkStatus();
}

}  // namespace bccskel::cli
