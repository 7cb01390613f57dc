#include <algorithm>
#include <concepts>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "client/cli/arguments.h"
#include "client/cli/common_options.h"
#include "client/cli/load_object.h"
#include "client/cli/thinning_options.h"
#include "client/endpoint.h"
#include "client/export/label_paths.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"
#include "core/import/image/open_image.h"

// Checks arguments against each other. The parser has checked each alone.

namespace bccskel::cli {
namespace {

absl::Status CheckVolumeName(const std::string& path) {
  const absl::StatusOr<exporting::SkeletonFormat> format = exporting::SkeletonFormatOf(path);
  if (format.ok() && *format == exporting::SkeletonFormat::kVolume) return absl::OkStatus();
  return absl::InvalidArgumentError(path + ": a volume file ends in .exr or .bccb");
}

// Overwriting the input would destroy data that cannot be recomputed.
absl::Status CheckNotInput(const std::string& input, const std::string& output) {
  std::error_code none;
  if (!std::filesystem::equivalent(input, output, none)) return absl::OkStatus();
  return absl::InvalidArgumentError(output + ": is also the input and would be overwritten");
}

bool IsGiven(const VoxelizeOptions& grid) {
  return grid.points.has_value() || grid.spacing.has_value() || grid.fill != FillRule::kAuto ||
         grid.thin_parts != ThinParts::kKeep || grid.axes != LatticeAxes::kShape;
}

// Each option about making an object is for one kind of input.
absl::Status CheckObject(const std::string& input, const VoxelizeOptions& grid,
                         const ImageArguments& image) {
  BCCSKEL_RETURN_IF_ERROR(ForegroundOf(image).status());
  const absl::StatusOr<InputKind> kind = InputKindOf(input, image);
  if (!kind.ok()) return absl::OkStatus();
  const std::string is = "; " + input + " is " + std::string(InputKindPhrase(*kind));
  if (IsGiven(grid) && *kind != InputKind::kMesh) {
    return absl::InvalidArgumentError(
        "--points, --spacing, --fill, --thin-parts and --lattice-axes are for meshes" + is);
  }
  if (*kind == InputKind::kImage) return CheckImageChoice(input, image.open);
  if (!image.given) return absl::OkStatus();
  return absl::InvalidArgumentError("--label, --range, --threshold and the like are for images" +
                                    is);
}

absl::Status CheckBorder(const SkeletonizeArguments& arguments) {
  if (arguments.skeletonize.border != Border::kContinues) return absl::OkStatus();
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.input, arguments.image);
  if (!kind.ok() || *kind != InputKind::kMesh) return absl::OkStatus();
  return absl::InvalidArgumentError("--border is for images and volumes; " + arguments.input +
                                    " is a mesh");
}

absl::Status CheckImages(const SkeletonizeArguments& arguments) {
  if (!arguments.images.wanted()) return absl::OkStatus();
  for (const std::string& path : {arguments.images.branches, arguments.images.curves}) {
    if (!path.empty() && !absl::EndsWithIgnoreCase(path, ".nrrd")) {
      return absl::InvalidArgumentError(path + ": does not end in .nrrd");
    }
    BCCSKEL_RETURN_IF_ERROR(CheckNotInput(arguments.input, path));
  }
  if (arguments.skeletonize.preparing.Wanted()) {
    return absl::InvalidArgumentError(
        "--branch-image and --curve-image show the original voxels and cannot be combined with "
        "what changes them: --denoise, --fill-cavities, --join-gaps, --cut-loops, --min-component, "
        "--min-component-volume, --keep-largest, or a --preset other than cad");
  }
  const absl::StatusOr<InputKind> kind = InputKindOf(arguments.input, arguments.image);
  if (!kind.ok() || *kind == InputKind::kImage) return absl::OkStatus();
  return absl::InvalidArgumentError("--branch-image and --curve-image are for images; " +
                                    arguments.input + " is " + std::string(InputKindPhrase(*kind)));
}

absl::Status Validate(const SkeletonizeArguments& arguments) {
  const bool detached = arguments.waiting == Waiting::kDetach;
  if (!detached && arguments.outputs.empty()) {
    return absl::InvalidArgumentError("--output is required");
  }
  if (detached && !arguments.outputs.empty()) {
    return absl::InvalidArgumentError(
        "--detach writes no files; bccskel fetch does, when the job has ended");
  }
  if (!detached && arguments.thin_volume == client::ThinVolume::kReturn) {
    return absl::InvalidArgumentError(
        "--thin-volume is for --detach; without it -o FILE.exr or FILE.bccb asks for the volume");
  }
  for (const std::string& output : arguments.outputs) {
    BCCSKEL_RETURN_IF_ERROR(exporting::SkeletonFormatOf(output).status());
    BCCSKEL_RETURN_IF_ERROR(CheckNotInput(arguments.input, output));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckObject(arguments.input, arguments.grid, arguments.image));
  BCCSKEL_RETURN_IF_ERROR(CheckImages(arguments));
  BCCSKEL_RETURN_IF_ERROR(CheckBorder(arguments));
  return ValidateOptions(arguments.skeletonize);
}

absl::Status Validate(const VoxelizeArguments& arguments) {
  return CheckObject(arguments.input, arguments.grid, arguments.image);
}

absl::Status Validate(const ResultArguments& arguments) {
  if (arguments.object.empty() && (arguments.image.given || IsGiven(arguments.grid))) {
    return absl::InvalidArgumentError(
        "options such as --label, --voxel-size and --points say how the object is read; name it "
        "with --object");
  }
  for (const std::string& input : {arguments.result, arguments.object}) {
    BCCSKEL_RETURN_IF_ERROR(CheckNotInput(input, arguments.output));
  }
  return CheckObject(arguments.object, arguments.grid, arguments.image);
}

absl::Status Validate(const LabelsArguments& arguments) {
  const bool on_server = arguments.place == Place::kServer;
  if (on_server && arguments.image.mask.sampling.has_value()) {
    return absl::InvalidArgumentError(
        "--sampling is for this machine; a server converts labels exactly");
  }
  for (const std::string& output : arguments.outputs) {
    BCCSKEL_RETURN_IF_ERROR(exporting::CheckLabelOutput(output));
    if (on_server &&
        exporting::SkeletonFormatOf(output).value() == exporting::SkeletonFormat::kVolume) {
      return absl::InvalidArgumentError(
          output + ": a server returns no thinned volumes of labels; compute here with --local");
    }
    BCCSKEL_RETURN_IF_ERROR(CheckNotInput(arguments.input, output));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckImageChoice(arguments.input, arguments.image.open));
  BCCSKEL_RETURN_IF_ERROR(ValidateRootOfLabels(arguments.root));
  return ValidateOptions(arguments.skeletonize);
}

absl::Status CheckFetch(const std::string& object, const std::string& output) {
  using exporting::SkeletonFormat;
  const absl::StatusOr<SkeletonFormat> format = exporting::SkeletonFormatOf(output);
  if (!format.ok()) return format.status();
  if (exporting::ShowsObject(*format) && object.empty()) {
    return absl::InvalidArgumentError(
        output + ": also shows the object: name the volume that was submitted with --object");
  }
  return CheckNotInput(object, output);
}

absl::Status Validate(const FetchArguments& arguments) {
  for (const std::string& output : arguments.outputs) {
    BCCSKEL_RETURN_IF_ERROR(CheckFetch(arguments.object, output));
  }
  return arguments.object.empty() ? absl::OkStatus() : CheckVolumeName(arguments.object);
}

absl::Status Validate(const InfoArguments& arguments) {
  return CheckObject(arguments.file, {}, arguments.image);
}

// The server that the command calls; null: none.
template <typename Chosen>
const ServerArguments* ServerOf(const Chosen& arguments) {
  if constexpr (requires { arguments.place; }) {
    return arguments.place == Place::kServer ? &arguments.server : nullptr;
  } else if constexpr (requires { arguments.server; }) {
    return &arguments.server;
  } else if constexpr (requires { arguments.job.server; }) {
    return &arguments.job.server;
  }
  return nullptr;
}

absl::Status CheckServer(const ServerArguments* server) {
  if (server == nullptr) return absl::OkStatus();
  const bool authority = !server->tls_ca.empty(), shown = !server->tls_certificate.empty();
  const absl::Status status = client::CheckAddress(
      server->address, authority ? client::Encryption::kTls : client::Encryption::kNone);
  if (!status.ok()) {
    return absl::Status(status.code(), "--server: " + std::string(status.message()));
  }
  if (shown == server->tls_key.empty()) {
    return absl::InvalidArgumentError("--tls-cert and --tls-key belong together");
  }
  if (!shown || authority) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "--tls-cert and --tls-key need --tls-ca, the authority that signed the server's certificate");
}

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

// Refuses "a.swc,b.csv", but not "a,b.csv".
template <typename Chosen>
absl::Status CheckCommas(const std::string& path) {
  std::vector<std::string> names;
  for (const std::string& part : std::vector<std::string>(absl::StrSplit(path, ','))) {
    if (names.empty() || exporting::SkeletonFormatOf(names.back()).ok()) {
      names.emplace_back(absl::StripLeadingAsciiWhitespace(part));
    } else {
      names.back() += "," + part;
    }
  }
  if (names.size() == 1) return absl::OkStatus();
  if (names.back().empty()) names.pop_back();
  constexpr bool kSeveral = requires(const Chosen& chosen) { chosen.outputs; };
  return absl::InvalidArgumentError(absl::StrCat(
      path, ": -o names one file",
      kSeveral || names.size() == 1 ? "; write -o " + absl::StrJoin(names, " -o ")
                                    : ", and this command writes one; run it for each"));
}

template <typename Chosen>
absl::Status CheckFileNames(const Chosen& arguments) {
  std::vector<std::string> paths;
  if constexpr (requires { arguments.input; }) paths.push_back(arguments.input);
  if constexpr (requires { arguments.file; }) paths.push_back(arguments.file);
  if constexpr (requires { arguments.result; }) paths.push_back(arguments.result);
  if constexpr (requires { arguments.object; }) paths.push_back(arguments.object);
  if (std::ranges::count(paths, "-") > 0) {
    return absl::InvalidArgumentError("-: standard input is not read; save it to a file first");
  }
  paths = OutputsOf(arguments);
  for (const std::string& path : paths) {
    if (path.starts_with('=')) {
      const std::string name = path.substr(1);
      return absl::InvalidArgumentError(
          absl::StrCat(path, ": begins with '='; write -o ", name, " or --output=", name));
    }
    BCCSKEL_RETURN_IF_ERROR(CheckCommas<Chosen>(path));
  }
  if (std::ranges::count(paths, "-") == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "-: standard output is not written; name a file, whose ending chooses the format");
}

template <typename Chosen>
absl::Status CheckSwcStep(const Chosen& arguments) {
  if constexpr (requires { arguments.swc; }) {
    const auto takes_it = [](const std::string& path) {
      const absl::StatusOr<exporting::SkeletonFormat> format = exporting::SkeletonFormatOf(path);
      return !format.ok() || *format == exporting::SkeletonFormat::kSwc ||
             *format == exporting::SkeletonFormat::kPrecomputed;
    };
    if (arguments.swc.step.has_value() && std::ranges::none_of(OutputsOf(arguments), takes_it)) {
      return absl::InvalidArgumentError("--swc-step is for .swc and .precomputed outputs");
    }
  }
  return absl::OkStatus();
}

// The resolved path, also for a file that does not exist yet.
std::filesystem::path PlaceOf(const std::string& path) {
  std::error_code error;
  std::filesystem::path place =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  return error ? std::filesystem::path(path) : place;
}

template <typename Chosen>
absl::Status CheckOutputNames(const Chosen& arguments) {
  std::set<std::filesystem::path> places;
  for (const std::string& path : OutputsOf(arguments)) {
    if (!std::same_as<Chosen, LabelsArguments> && exporting::IsForEachLabel(path)) {
      return absl::InvalidArgumentError(
          path + ": only `bccskel labels` puts the number of a label in place of " +
          std::string(exporting::kLabelPlace));
    }
    if (!places.insert(PlaceOf(path)).second) {
      return absl::InvalidArgumentError(path +
                                        ": is an output already; each needs a file of its own");
    }
  }
  return absl::OkStatus();
}

template <typename Other>
absl::Status Validate(const Other&) requires(!std::derived_from<Other, ResultArguments>) {
  return absl::OkStatus();
}

}  // namespace

absl::Status Validate(const Arguments& arguments) {
  BCCSKEL_RETURN_IF_ERROR(
      std::visit([](const auto& chosen) { return CheckServer(ServerOf(chosen)); }, arguments));
  BCCSKEL_RETURN_IF_ERROR(
      std::visit([](const auto& chosen) { return CheckFileNames(chosen); }, arguments));
  BCCSKEL_RETURN_IF_ERROR(
      std::visit([](const auto& chosen) { return Validate(chosen); }, arguments));
  BCCSKEL_RETURN_IF_ERROR(
      std::visit([](const auto& chosen) { return CheckSwcStep(chosen); }, arguments));
  return std::visit([](const auto& chosen) { return CheckOutputNames(chosen); }, arguments);
}

namespace {

// The first folder or file to be created for a label; its parent must exist.
std::string FirstMadeFor(const std::string& path) {
  return path.substr(0, path.find('/', path.find(exporting::kLabelPlace)));
}

// The outputs that are written first.
template <typename Chosen>
std::vector<std::string> FirstOutputsOf(const Chosen& arguments) {
  std::vector<std::string> paths = OutputsOf(arguments);
  if constexpr (std::same_as<Chosen, LabelsArguments>) {
    std::ranges::transform(paths, paths.begin(), FirstMadeFor);
  }
  return paths;
}

}  // namespace

absl::Status CheckServerFiles(const Arguments& arguments) {
  const ServerArguments* server =
      std::visit([](const auto& chosen) { return ServerOf(chosen); }, arguments);
  if (server == nullptr) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const client::Endpoint endpoint, EndpointOf(*server));
  return client::CheckEndpoint(endpoint);
}

absl::Status CheckOutputs(const Arguments& arguments) {
  const std::vector<std::string> paths =
      std::visit([](const auto& chosen) { return FirstOutputsOf(chosen); }, arguments);
  for (const std::string& path : paths) {
    BCCSKEL_RETURN_IF_ERROR(exporting::CheckOutput(path));
  }
  return absl::OkStatus();
}

}  // namespace bccskel::cli
