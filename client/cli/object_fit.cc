#include "client/cli/object_fit.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_format.h"
#include "client/view/result_balls.h"
#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

// A box may be off by this part of its edge, and by two cells, as grids differ.
constexpr double kSlack = 0.1;
constexpr double kSlackCells = 2;
// And volumes by this factor.
constexpr double kMostVolumes = 2;

struct Range {
  double low;
  double high;
};
using LatticeBox = std::array<Range, 3>;

// Needs: points.
LatticeBox BoxOf(const Volume& object) {
  constexpr Range kNone = {2.0 * kMaxExtentCells, -1};
  LatticeBox box = {kNone, kNone, kNone};
  object.ForEachPoint([&](LatticePoint p) {
    const std::array<int32_t, 3> place = {p.x, p.y, p.z};
    for (size_t axis = 0; axis < 3; ++axis) {
      box[axis] = {std::min<double>(box[axis].low, place[axis]),
                   std::max<double>(box[axis].high, place[axis])};
    }
  });
  return box;
}

absl::Status CheckBoxes(const view::ResultDocument& result, const Volume& object) {
  const LatticeBox box = BoxOf(object);
  for (const OpenBall& ball : view::BallsOf(result, object.placement())) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = box[axis];
      const double unit = object.placement().spacing[axis] / 2;
      const double slack = kSlack * (high - low) + 2 * kSlackCells;
      const double inside = std::min(ball.center[axis] - low, high - ball.center[axis]);
      const double radius = result.border_continues ? 0 : ball.radius;
      if (radius / unit - inside <= slack) continue;
      return absl::InvalidArgumentError(absl::StrFormat(
          "is not what the result was made from: there the object reaches %.4g beyond this one's "
          "box along the axis %c of its grid",
          radius - inside * unit, "xyz"[axis]));
    }
  }
  return absl::OkStatus();
}

double VolumeOf(uint64_t points, const Placement& placement) {
  const auto& [x, y, z] = placement.spacing;
  return static_cast<double>(points) * x * y * z / 2;
}

absl::Status CheckVolumes(const view::ResultDocument& result, const Volume& object) {
  if (!result.placement.has_value()) return absl::OkStatus();
  const double here = VolumeOf(object.PointCount(), object.placement());
  const double there = VolumeOf(result.object_points, *result.placement);
  if (std::max(here, there) <= kMostVolumes * std::min(here, there)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "is not what the result was made from: its volume is %.4g, there it is %.4g", here, there));
}

}  // namespace

absl::Status CheckObjectFits(const view::ResultDocument& result, const Volume& object) {
  if (object.empty() && result.object_points == 0) return absl::OkStatus();
  if (object.empty()) {
    return absl::InvalidArgumentError("is empty; what the result was made from is not");
  }
  BCCSKEL_RETURN_IF_ERROR(CheckBoxes(result, object));
  return CheckVolumes(result, object);
}

}  // namespace bccskel::cli
