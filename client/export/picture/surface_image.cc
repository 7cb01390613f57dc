#include "client/export/picture/surface_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <utility>

namespace bccskel::exporting {
namespace {

// Above this many layers over a picture it pays to remove hidden points.
constexpr double kMostLayers = 8;
constexpr float kEmpty = -std::numeric_limits<float>::infinity();

// The nearest depth at every pixel.
class DepthMap {
 public:
  DepthMap(int width, int height)
      : width_(width),
        height_(height),
        depth_(static_cast<size_t>(width) * static_cast<size_t>(height), kEmpty) {}

  int width() const { return width_; }
  int height() const { return height_; }
  float At(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return kEmpty;
    return depth_[Index(x, y)];
  }
  bool Covered(int x, int y) const { return At(x, y) != kEmpty; }

  // Draws a sphere around a point.
  void AddSphere(const PanelPoint& p, double radius) {
    const int low_x = std::max(0, static_cast<int>(std::ceil(p.x - radius)));
    const int low_y = std::max(0, static_cast<int>(std::ceil(p.y - radius)));
    const int high_x = std::min(width_ - 1, static_cast<int>(std::floor(p.x + radius)));
    const int high_y = std::min(height_ - 1, static_cast<int>(std::floor(p.y + radius)));
    for (int y = low_y; y <= high_y; ++y) {
      for (int x = low_x; x <= high_x; ++x) Raise(x, y, p, radius);
    }
  }

  // Averages every pixel with the eight that lie `stride` away on the same piece of surface.
  void Smooth(int stride, float largest_step) {
    std::vector<float> next = depth_;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (Covered(x, y)) next[Index(x, y)] = MeanAround(x, y, stride, largest_step);
      }
    }
    depth_ = std::move(next);
  }

 private:
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }

  void Raise(int x, int y, const PanelPoint& p, double radius) {
    const double dx = x - p.x, dy = y - p.y, rest = radius * radius - dx * dx - dy * dy;
    if (rest < 0) return;
    float& depth = depth_[Index(x, y)];
    depth = std::max(depth, static_cast<float>(p.depth + std::sqrt(rest)));
  }

  // Binomial weights: strides of 1, 2, 4, ... together approximate a Gaussian.
  float MeanAround(int x, int y, int stride, float largest_step) const {
    const float here = At(x, y);
    float sum = 0, total = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const float there = At(x + stride * dx, y + stride * dy);
        if (!(std::abs(there - here) <= largest_step)) continue;
        const auto weight = static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)));
        sum += weight * there;
        total += weight;
      }
    }
    return sum / total;
  }

  int width_;
  int height_;
  std::vector<float> depth_;
};

struct Normal {
  float x;
  float y;
  float z;
};

// Slope along one axis from the neighbors on the same piece of surface; steep if there are none.
float SlopeOf(float before, float here, float after, float largest_step) {
  const bool has_before = std::abs(here - before) <= largest_step;
  const bool has_after = std::abs(after - here) <= largest_step;
  if (has_before && has_after) return (after - before) / 2;
  if (has_after) return after - here;
  if (has_before) return here - before;
  return 0;
}

Normal NormalAt(const DepthMap& depth, int x, int y, float largest_step) {
  const float here = depth.At(x, y);
  const float right = SlopeOf(depth.At(x - 1, y), here, depth.At(x + 1, y), largest_step);
  const float down = SlopeOf(depth.At(x, y - 1), here, depth.At(x, y + 1), largest_step);
  const float length = std::sqrt(right * right + down * down + 1);
  return {-right / length, down / length, 1 / length};
}

// The part of each pixel that the object covers, its outline smoothed over `reach` pixels.
class Coverage {
 public:
  Coverage(const DepthMap& depth, int reach) : depth_(depth), width_(depth.width()) {
    std::vector<float> covered(Size());
    for (int y = 0; y < depth.height(); ++y) {
      for (int x = 0; x < width_; ++x) covered[Index(x, y)] = depth.Covered(x, y) ? 1.0f : 0.0f;
    }
    const std::vector<float> rows = BoxMean(covered, reach, 1, 0);
    mean_ = BoxMean(rows, reach, 0, 1);
    sharpness_ = static_cast<float>(reach) + 1;
  }

  float At(int x, int y) const {
    if (!depth_.Covered(x, y)) return 0;
    return std::clamp((mean_[Index(x, y)] - 0.5f) * sharpness_ + 0.5f, 0.0f, 1.0f);
  }

 private:
  size_t Size() const { return static_cast<size_t>(width_) * static_cast<size_t>(depth_.height()); }
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }

  std::vector<float> BoxMean(const std::vector<float>& values, int reach, int dx, int dy) const {
    std::vector<float> mean(values.size());
    for (int y = 0; y < depth_.height(); ++y) {
      for (int x = 0; x < width_; ++x) {
        float sum = 0;
        for (int step = -reach; step <= reach; ++step) {
          const int u = std::clamp(x + step * dx, 0, width_ - 1);
          const int v = std::clamp(y + step * dy, 0, depth_.height() - 1);
          sum += values[Index(u, v)];
        }
        mean[Index(x, y)] = sum / static_cast<float>(2 * reach + 1);
      }
    }
    return mean;
  }

  const DepthMap& depth_;
  int width_;
  std::vector<float> mean_;
  float sharpness_ = 1;
};

// Slate blue glass under a lamp from the upper left.
std::array<uint8_t, 4> GlassColor(const Normal& n, float coverage) {
  constexpr Normal kLamp = {-0.45f, 0.65f, 0.61f};
  const float light = std::max(0.0f, n.x * kLamp.x + n.y * kLamp.y + n.z * kLamp.z);
  const float tilt = 1 - n.z;
  const float shade = 0.62f + 0.38f * light - 0.25f * tilt;
  const float opacity = coverage * std::min(1.0f, 0.20f + 0.16f * (1 - light) + 0.62f * tilt);
  const auto byte = [](float v) {
    return static_cast<uint8_t>(std::lround(std::clamp(v, 0.0f, 255.0f)));
  };
  return {byte(118 * shade), byte(152 * shade), byte(196 * shade), byte(255 * opacity)};
}

RgbaImage Shade(const DepthMap& depth, const Coverage& coverage, float largest_step) {
  RgbaImage image{static_cast<uint32_t>(depth.width()), static_cast<uint32_t>(depth.height()), {}};
  image.pixels.reserve(size_t{4} * image.width * image.height);
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      std::array<uint8_t, 4> color = {};
      if (const float part = coverage.At(x, y); part > 0) {
        color = GlassColor(NormalAt(depth, x, y, largest_step), part);
      }
      image.pixels.insert(image.pixels.end(), color.begin(), color.end());
    }
  }
  return image;
}

}  // namespace

std::vector<PanelPoint> NearestOfEachPlace(std::span<const PanelPoint> points) {
  constexpr double kPlaces = 4096;  // per pixel: smaller differences are rounding errors
  struct Place {
    int64_t x, y;
    double behind;
    size_t point;

    auto operator<=>(const Place&) const = default;
  };
  std::vector<Place> places;
  places.reserve(points.size());
  for (const PanelPoint& p : points) {
    places.push_back(
        {std::llround(p.x * kPlaces), std::llround(p.y * kPlaces), -p.depth, places.size()});
  }
  std::ranges::sort(places);
  // std::ranges::unique does not compile with clang 14 and this standard library.
  const auto end = std::unique(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.x == b.x && a.y == b.y;
  });
  std::vector<PanelPoint> nearest;
  for (auto place = places.begin(); place != end; ++place) nearest.push_back(points[place->point]);
  return nearest;
}

RgbaImage RenderSurface(std::span<const PanelPoint> surface, double point_radius, uint32_t width,
                        uint32_t height) {
  DepthMap depth(static_cast<int>(width), static_cast<int>(height));
  const double radius = std::max(point_radius, 0.8);
  std::vector<PanelPoint> nearest;
  const double pixels = static_cast<double>(width) * height;
  if (radius * radius * static_cast<double>(surface.size()) > kMostLayers * pixels) {
    nearest = NearestOfEachPlace(surface);
    surface = nearest;
  }
  for (const PanelPoint& p : surface) depth.AddSphere(p, radius);
  // Averaging over about three point radii hides the lattice. Wide strides leave steps beside
  // outlines, so narrow ones follow, several times.
  const auto largest_step = static_cast<float>(4 * radius);
  const auto widest = std::bit_floor(static_cast<unsigned>(std::clamp(radius, 2.0, 16.0)));
  for (unsigned stride = widest; stride > 1; stride /= 2) {
    depth.Smooth(static_cast<int>(stride), largest_step);
  }
  for (int turn = 0; turn < 8; ++turn) depth.Smooth(1, largest_step);
  const int reach = static_cast<int>(std::clamp(radius, 1.0, 12.0));
  return Shade(depth, Coverage(depth, reach), largest_step);
}

}  // namespace bccskel::exporting
