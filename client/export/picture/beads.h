#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_BEADS_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_BEADS_H_

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "client/export/picture/curve_colors.h"
#include "client/export/picture/projection.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"

namespace bccskel::exporting {

using LinearColor = std::array<float, 3>;  // red, green, blue, 0..1

// A ball in sample coordinates: x to the right, y down, a larger depth is nearer to the viewer.
struct Bead {
  float x;
  float y;
  float depth;
  float radius;
  LinearColor color;
};

// In parts, of which threads make one at a time: large nets have millions.
using Beads = std::vector<std::vector<Bead>>;

RadiusRange RadiusRangeOf(const view::ResultDocument& result);

LinearColor LinearOf(const std::array<double, 3>& rgb);  // 0..255 each

// Curves and sheets are colored by radius, those of many labels by label. Needs: the result
// outlives it.
class CurveColors {
 public:
  explicit CurveColors(const view::ResultDocument& result);

  // Equal numbers mean equal colors. Needs: labels[n] if the result has any.
  int NumberOf(const std::vector<uint32_t>& labels, size_t n, double radius) const {
    return labeled() ? static_cast<int>(labels[n]) : RadiusColorIndex(radius, range_);
  }
  int NumberAt(const view::ResultDocument::Edge& edge, double radius) const {
    return NumberOf(labels_.of_nodes, edge.source, radius);
  }
  int NumberOfSheet(size_t point) const {
    return NumberOf(labels_.of_sheets, point, sheets_.radii[point]);
  }
  const std::array<double, 3>& Rgb(int number) const {
    return colors_[static_cast<size_t>(number)];
  }
  const LinearColor& Linear(int number) const { return linear_[static_cast<size_t>(number)]; }
  const RadiusRange& range() const { return range_; }

 private:
  static const view::ResultDocument::Labels kNoLabels;
  bool labeled() const { return &labels_ != &kNoLabels; }

  const view::ResultDocument::Labels& labels_;
  const view::ResultDocument::Sheets& sheets_;
  RadiusRange range_;
  std::vector<std::array<double, 3>> colors_;  // 0..255 each
  std::vector<LinearColor> linear_;            // the same
};

inline constexpr LinearColor kEndColor = {0.06f, 0.72f, 0.51f};
inline constexpr LinearColor kJunctionColor = {0.12f, 0.16f, 0.22f};
inline constexpr LinearColor kOtherColor = {0.01f, 0.52f, 0.78f};

// The skeleton as strings of beads that overlap so closely that they look like tubes, colored by
// radius, with a larger bead per node. Needs: the result outlives it.
class BeadStrings {
 public:
  // Errors: those of the context.
  static absl::StatusOr<BeadStrings> Of(const view::ResultDocument& result,
                                        const exec::Context& context);

  // Units: `thickness`, the radius of a tube, in units of the projection.
  // Errors: those of the context.
  absl::StatusOr<Beads> In(const Projection& projection, double thickness,
                           const exec::Context& context) const;

  const CurveColors& colors() const { return colors_; }
  // As it is drawn.
  std::span<const WorldPoint> CurveOf(const view::ResultDocument::Edge& edge) const {
    return std::span(curves_).subspan(edge.first_point, edge.point_count);
  }

 private:
  explicit BeadStrings(const view::ResultDocument& result);

  const view::ResultDocument& result_;
  CurveColors colors_;
  double length_ = 0;               // of all edges
  std::vector<WorldPoint> curves_;  // of all edges
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_BEADS_H_
