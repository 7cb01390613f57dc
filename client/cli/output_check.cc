#include "client/cli/output_check.h"

#include <string>
#include <variant>
#include <vector>

#include "client/cli/label_files.h"
#include "client/export/skeleton_file.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
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
