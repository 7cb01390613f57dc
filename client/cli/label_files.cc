#include "client/cli/label_files.h"

#include <string_view>
#include <utility>

#include "client/export/atomic_file.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

constexpr std::string_view kPlace = kLabelPlace;

bool IsForEach(const std::string& path) { return path.find(kPlace) != path.npos; }

std::string PathFor(std::string path, uint64_t label) {
  const std::string number = std::to_string(label);
  for (size_t at = path.find(kPlace); at != path.npos; at = path.find(kPlace, at)) {
    path.replace(at, kPlace.size(), number);
    at += number.size();
  }
  return path;
}

}  // namespace

absl::Status CheckLabelOutput(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(const exporting::SkeletonFormat format,
                           exporting::SkeletonFormatOf(path));
  if (format == exporting::SkeletonFormat::kSvg || format == exporting::SkeletonFormat::kHtml) {
    return absl::InvalidArgumentError(
        path + ": pictures show one object; use skeletonize --label for one label");
  }
  if (IsForEach(path) || exporting::HoldsManyLabels(format)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      path + ": this format holds one label; write " + kLabelPlace +
      " where its number shall stand, or put all labels into a .vtp, "
      ".graphml, .json, .csv, .glb or .mrk.json file or a .precomputed folder");
}

LabelFiles::LabelFiles(const std::vector<std::string>& paths, const std::optional<RootChoice>& root,
                       exporting::World world, exporting::CurveSampling swc)
    : root_(root), world_(std::move(world)), swc_(swc), all_(root, world_) {
  for (const std::string& path : paths) {
    (IsForEach(path) ? paths_of_each_ : paths_of_all_).push_back(path);
  }
}

absl::Status LabelFiles::Add(LabelSkeleton&& skeleton) {
  const std::string title = "label " + std::to_string(skeleton.label);
  const exporting::Subject subject = {.result = skeleton.result,
                                      .object = skeleton.result.thin,
                                      .title = title,
                                      .root = root_,
                                      .world = world_,
                                      .swc = swc_};
  for (const std::string& path : paths_of_each_) {
    BCCSKEL_RETURN_IF_ERROR(
        exporting::WriteSkeletonFile(PathFor(path, skeleton.label), subject).status());
  }
  ++labels_;
  if (!paths_of_all_.empty()) all_.Add(skeleton.label, skeleton.voxels, skeleton.result);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<WrittenFile>> LabelFiles::Finish(const std::stop_token& stop) && {
  std::vector<WrittenFile> files;
  for (const std::string& path : paths_of_each_) {
    files.push_back({path, std::to_string(labels_) + (labels_ == 1 ? " file" : " files")});
  }
  for (const std::string& path : paths_of_all_) {
    BCCSKEL_ASSIGN_OR_RETURN(std::string note, exporting::WriteLabeledFile(path, all_, stop));
    files.push_back({path, std::move(note)});
  }
  return files;
}

}  // namespace bccskel::cli
