#include "core/import/image/image_choice.h"

#include <optional>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

absl::Status CheckThere(const char* name, int64_t chosen, int64_t length) {
  if (chosen >= 0 && chosen < length) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s %d is not there: the image has %d, counted from 0", name, chosen, length));
}

}  // namespace

absl::StatusOr<int64_t> ChosenAlong(char axis, int64_t length, const ImageOptions& options) {
  const std::optional<int64_t> chosen = axis == 'C' ? options.channel : options.time;
  const char* const name = axis == 'C' ? "channel" : "time";
  if (!chosen.has_value() && length == 1) return 0;
  if (!chosen.has_value()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the image has %d %ss; choose one with --%s 0 to %d", length, name, name, length - 1));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckThere(name, *chosen, length));
  return *chosen;
}

absl::StatusOr<int64_t> ChosenLevel(int64_t levels, const ImageOptions& options) {
  const int64_t level = options.level.value_or(0);
  BCCSKEL_RETURN_IF_ERROR(CheckThere("level", level, levels));
  return level;
}

}  // namespace bccskel
