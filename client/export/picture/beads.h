#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_BEADS_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_BEADS_H_

#include <array>
#include <vector>

#include "client/export/picture/display_curve.h"
#include "client/export/picture/projection.h"
#include "client/view/result_document.h"

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

RadiusRange RadiusRangeOf(const view::ResultDocument& result);

LinearColor LinearOf(const std::array<double, 3>& rgb);  // 0..255 each

// The color of sheets of this radius.
LinearColor ColorOf(double radius, const RadiusRange& range);

// Curves are colored by radius, those of many labels by label. Needs: the result outlives it.
class CurveColors {
 public:
  explicit CurveColors(const view::ResultDocument& result);

  // Equal numbers mean equal colors. Needs: an edge of the result.
  int NumberAt(const view::ResultDocument::Edge& edge, double radius) const {
    if (labels_ == nullptr) return RadiusColorIndex(radius, range_);
    return static_cast<int>(labels_->of_nodes[edge.source]);
  }
  const std::array<double, 3>& Rgb(int number) const {
    return colors_[static_cast<size_t>(number)];
  }
  const RadiusRange& range() const { return range_; }

 private:
  const view::ResultDocument::Labels* labels_;
  const RadiusRange range_;
  std::vector<std::array<double, 3>> colors_;  // 0..255 each
};

inline constexpr LinearColor kEndColor = {0.06f, 0.72f, 0.51f};
inline constexpr LinearColor kJunctionColor = {0.12f, 0.16f, 0.22f};
inline constexpr LinearColor kOtherColor = {0.01f, 0.52f, 0.78f};

// The skeleton as strings of beads that overlap so closely that they look like tubes, colored by
// radius, with a larger bead per node.
// Units: `thickness`, the radius of a tube, in units of the projection.
std::vector<Bead> BeadsOf(const view::ResultDocument& result, const Projection& projection,
                          double thickness);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_BEADS_H_
