#include "client/export/label_paths.h"

#include <filesystem>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/export/labeled_graph.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"

namespace bccskel::exporting {
namespace {

std::string PathFor(const std::string& path, uint64_t label) {
  return absl::StrReplaceAll(path, {{kLabelPlace, absl::StrCat(label)}});
}

}  // namespace

bool IsForEachLabel(const std::string& path) { return path.find(kLabelPlace) != path.npos; }

absl::StatusOr<std::string> MakePathFor(const std::string& path, uint64_t label) {
  const size_t slash = path.rfind('/');
  if (slash == path.npos || path.find(kLabelPlace) > slash) return PathFor(path, label);
  const std::string folder = PathFor(path.substr(0, slash), label);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return absl::ErrnoToStatus(error.value(), "cannot create the folder " + folder);
  return PathFor(path, label);
}

absl::Status CheckLabelOutput(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, SkeletonFormatOf(path));
  if (IsForEachLabel(path) || HoldsManyLabels(format)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(path, ": this format holds one label; write ", kLabelPlace,
                   " where the label's number goes, or put all labels "
                   "into a .vtp, .graphml, .json, .csv, .glb, "
                   ".html, .svg, .png or .mrk.json file or a "
                   ".precomputed folder"));
}

}  // namespace bccskel::exporting
