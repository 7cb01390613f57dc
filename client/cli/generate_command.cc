#include <utility>

#include "client/cli/commands.h"
#include "client/cli/console.h"
#include "client/cli/json_text.h"
#include "client/cli/volume_summary.h"
#include "client/export/text.h"
#include "core/io/volume_file.h"

namespace bccskel::cli {
namespace {

std::string SummaryOf(const GenerateArguments& arguments, const Volume& volume) {
  exporting::Text text;
  if (arguments.common.summary == SummaryStyle::kJson) {
    text.Add("{\"shape\":\"", ShapeName(arguments.shape),
             "\",\"output\":", JsonString(arguments.output),
             ",\"volume\":", VolumeJson(volume, std::nullopt), "}\n");
  } else {
    text.Add("shape:       ", ShapeName(arguments.shape), '\n', VolumeText(volume, std::nullopt),
             "written:     ", arguments.output, '\n');
  }
  return std::move(text).Take();
}

}  // namespace

ExitCode Run(const GenerateArguments& arguments, const std::stop_token& stop) {
  const absl::StatusOr<Volume> volume = GenerateShape(arguments.shape, arguments.options);
  if (!volume.ok()) return FailWith(ExitCode::kUsage, volume.status());
  exec::Context context;
  context.stop = stop;
  const absl::Status written = WriteVolumeFile(arguments.output, *volume, {}, context);
  if (!written.ok()) return FailWith(ExitCode::kOutput, written);
  return Print(SummaryOf(arguments, *volume));
}

}  // namespace bccskel::cli
