#include "core/import/image/dicom_stack.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// Positions are written with a few digits: of the distance of slices, so much is rounding.
constexpr double kRounding = 0.01;

bool Near(const WorldPoint& a, const WorldPoint& b, double most) {
  const WorldPoint way = Minus(a, b);
  return Dot(way, way) <= most * most;
}

// A frame and its place along the normal.
struct Placed {
  double along;
  DicomFrame frame;
};

absl::Status CheckAlike(const DicomFrame& first, const DicomFrame& other) {
  const auto differ = [&](const char* what) {
    return absl::InvalidArgumentError(
        absl::StrFormat("'%s' and '%s' differ in their %s: they are not slices of one image",
                        first.name, other.name, what));
  };
  if (first.rows != other.rows || first.columns != other.columns) return differ("size");
  for (size_t axis = 0; axis < 2; ++axis) {
    const double gap = std::abs(first.spacing[axis] - other.spacing[axis]);
    if (!(gap <= 1e-3 * first.spacing[axis])) return differ("pixel spacing");
  }
  constexpr double kTurned = 1e-3;
  if (!Near(first.along_row, other.along_row, kTurned) ||
      !Near(first.along_column, other.along_column, kTurned)) {
    return differ("orientation");
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<Placed>> Sorted(std::vector<DicomFrame> frames) {
  const WorldPoint normal = Cross(frames.front().along_row, frames.front().along_column);
  std::vector<Placed> placed;
  for (const DicomFrame& frame : frames) {
    BCCSKEL_RETURN_IF_ERROR(CheckAlike(frames.front(), frame));
  }
  for (DicomFrame& frame : frames) {
    const double along = Dot(normal, frame.position);
    placed.push_back({along, std::move(frame)});
  }
  std::ranges::stable_sort(placed, {}, &Placed::along);
  return placed;
}

double SmallestGap(const std::vector<Placed>& frames) {
  double smallest = 0;
  for (size_t n = 1; n < frames.size(); ++n) {
    const double gap = frames[n].along - frames[n - 1].along;
    // Frames of several segments have the same positions but for rounding.
    if (gap > 1e-3 && (smallest == 0 || gap < smallest)) smallest = gap;
  }
  return smallest;
}

absl::Status CheckGap(const Placed& before, const Placed& after, double step) {
  const double gap = after.along - before.along;
  if (std::abs(gap - step) <= kRounding * step) return absl::OkStatus();
  const std::string between =
      absl::StrFormat("between '%s' and '%s'", before.frame.name, after.frame.name);
  if (gap <= kRounding * step) {
    return absl::InvalidArgumentError(
        "two slices lie at one position, " + between.substr(8) +
        ": they are of several times, echoes or reconstructions; keep one of each in the folder");
  }
  const double steps = std::round(gap / step);
  if (steps >= 2 && std::abs(gap - steps * step) <= kRounding * gap) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d slices are missing %s", static_cast<int64_t>(steps) - 1, between));
  }
  return absl::InvalidArgumentError(absl::StrFormat(
      "slices are spaced unevenly: %g mm %s, %g mm mostly; resample the image first", gap, between,
      step));
}

// The distance of most neighbors.
double MedianGap(const std::vector<Placed>& frames) {
  std::vector<double> gaps;
  for (size_t n = 1; n < frames.size(); ++n) {
    gaps.push_back(frames[n].along - frames[n - 1].along);
  }
  if (gaps.empty()) return 0;
  std::ranges::nth_element(gaps, gaps.begin() + static_cast<ptrdiff_t>(gaps.size() / 2));
  return gaps[gaps.size() / 2];
}

// How far apart slices are; of a single one its thickness, or 1.
absl::StatusOr<double> StepOf(const std::vector<Placed>& frames, DicomGaps gaps) {
  const DicomFrame& first = frames.front().frame;
  const double alone = first.thickness > 0 ? first.thickness : 1;
  if (gaps == DicomGaps::kEmpty) {
    const double smallest = SmallestGap(frames);
    if (smallest == 0) return alone;
    // Where every second slice is empty, the smallest gap is twice the distance of slices.
    const double times = first.thickness > 0 ? std::round(smallest / first.thickness) : 1;
    const bool whole =
        times >= 1 && std::abs(smallest - times * first.thickness) <= kRounding * first.thickness;
    return whole ? smallest / times : smallest;
  }
  if (frames.size() == 1) return alone;
  const double step = MedianGap(frames);
  for (size_t n = 1; n < frames.size(); ++n) {
    BCCSKEL_RETURN_IF_ERROR(CheckGap(frames[n - 1], frames[n], step));
  }
  return (frames.back().along - frames.front().along) / static_cast<double>(frames.size() - 1);
}

// The step from slice to slice, as a vector.
WorldPoint StepVector(const std::vector<Placed>& frames, double step) {
  const DicomFrame& first = frames.front().frame;
  const double length = frames.back().along - frames.front().along;
  const double steps = std::round(length / step);
  if (steps == 0) return Times(step, Cross(first.along_row, first.along_column));
  const WorldPoint way = Minus(frames.back().frame.position, first.position);
  return Times(1 / steps, way);
}

// Slices of a tilted gantry are each moved against the one before within their plane.
absl::Status CheckStraight(const DicomFrame& first, const WorldPoint& along_z) {
  constexpr double kMostLean = 1e-3;  // of the step, as for every image
  const WorldPoint normal = Cross(first.along_row, first.along_column);
  const double step = Dot(normal, along_z);
  const WorldPoint aside = Sum(along_z, -step, normal);
  const double moved = LengthOf(aside);
  if (moved <= kMostLean * std::abs(step)) return absl::OkStatus();
  constexpr double kDegrees = 180 / std::numbers::pi;
  return absl::InvalidArgumentError(
      absl::StrFormat("each slice is moved by %.3g mm against the one before, as by a gantry "
                      "tilted by %.1f degrees; "
                      "resample the series to a straight grid first",
                      moved, kDegrees * std::atan2(moved, std::abs(step))));
}

}  // namespace

absl::StatusOr<DicomStack> StackFrames(std::vector<DicomFrame> unsorted, DicomGaps gaps,
                                       const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<Placed> frames, Sorted(std::move(unsorted)));
  BCCSKEL_ASSIGN_OR_RETURN(const double step, StepOf(frames, gaps));
  const DicomFrame first = frames.front().frame;
  const WorldPoint along_z = StepVector(frames, step);
  BCCSKEL_RETURN_IF_ERROR(CheckStraight(first, along_z));
  const double slices = std::round((frames.back().along - frames.front().along) / step) + 1;
  const double most = static_cast<double>(limits.max_axis_voxels) + 1;
  const std::array<int64_t, 3> lengths = {first.columns, first.rows,
                                          static_cast<int64_t>(std::min(slices, most))};
  DicomStack stack;
  BCCSKEL_ASSIGN_OR_RETURN(stack.size, SizeOfAxes(lengths, limits));
  BCCSKEL_ASSIGN_OR_RETURN(
      stack.placement,
      PlacementOfSteps({Times(first.spacing[0], first.along_row),
                        Times(first.spacing[1], first.along_column), along_z},
                       first.position, std::array{first.spacing[0], first.spacing[1], step}));
  stack.slices.resize(static_cast<size_t>(stack.size.nz));
  for (Placed& placed : frames) {
    const double z = std::round((placed.along - frames.front().along) / step);
    const double beside = 5 * kRounding * std::max({first.spacing[0], first.spacing[1], step});
    if (!Near(placed.frame.position, Sum(first.position, z, along_z), beside)) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "'%s' lies beside the line of the other slices; they are not of one image",
          placed.frame.name));
    }
    stack.slices[static_cast<size_t>(z)].push_back(std::move(placed.frame));
  }
  return stack;
}

}  // namespace bccskel
