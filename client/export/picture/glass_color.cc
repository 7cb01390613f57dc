#include "client/export/picture/glass_color.h"

#include <algorithm>
#include <cmath>

namespace bccskel::exporting {
namespace {

// Light on a surface from a lamp at the upper left in front of it.
struct Light {
  float diffuse;
  float gleam;   // the lamp's reflection
  float facing;  // 1 if the surface faces the viewer, 0 at outlines
};

Light LightOn(ViewNormal n, float sharpness) {
  constexpr ViewNormal kLamp = {-0.45f, 0.65f, 0.61f};
  const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const float sign = n[2] < 0 ? -1.0f : 1.0f;  // a far side is seen from inside
  if (length > 0) {
    for (float& part : n) part *= sign / length;
  }
  const float along = n[0] * kLamp[0] + n[1] * kLamp[1] + n[2] * kLamp[2];
  const float mirrored = std::max(0.0f, 2 * along * n[2] - kLamp[2]);
  return {std::max(0.0f, along), std::pow(mirrored, sharpness), n[2]};
}

void Cover(LinearColor& below, const LinearColor& above, float opacity) {
  const float part = std::clamp(opacity, 0.0f, 1.0f);
  for (size_t n = 0; n < 3; ++n) below[n] += part * (std::min(1.0f, above[n]) - below[n]);
}

// `body` is the opacity of glass that faces the viewer.
void CoverWithGlass(LinearColor& below, const Hit& glass, float body) {
  const Light light = LightOn(glass.normal, 30);
  const float rim = 1 - light.facing;
  LinearColor color;
  for (size_t n = 0; n < 3; ++n) {
    color[n] = glass.color[n] * (0.70f + 0.42f * light.diffuse - 0.22f * rim) + 0.28f * light.gleam;
  }
  Cover(below, color,
        body * (0.22f + 0.20f * (1 - light.diffuse)) + 0.80f * std::pow(rim, 1.7f) +
            0.18f * light.gleam);
}

LinearColor BeadColor(const Hit& bead) {
  const Light light = LightOn(bead.normal, 24);
  LinearColor shaded;
  for (size_t n = 0; n < 3; ++n) {
    shaded[n] = bead.color[n] * (0.55f + 0.5f * light.diffuse) + 0.35f * light.gleam;
  }
  return shaded;
}

}  // namespace

LinearColor ColorAt(const Band& band, int x, int row) {
  LinearColor color = kPaperColor;
  const Hit near = band.near_glass(x, row), bead = band.bead(x, row);
  if (bead.depth != -kNothing) {
    Cover(color, BeadColor(bead), 1);
  } else if (const Hit far = band.far_glass(x, row); far.depth < near.depth) {
    CoverWithGlass(color, far, 0.15f);
  }
  if (near.depth > bead.depth) CoverWithGlass(color, near, 0.8f);
  return color;
}

}  // namespace bccskel::exporting
