#include "core/import/voxelize/crossings.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {
namespace {

using Vertex = TriangleMesh::Vertex;
using Triangle = TriangleMesh::Triangle;

// Six times the signed volume of a tetrahedron.
double Volume6(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  const auto from_d = [&](const Vertex& v) {
    return Vertex{v[0] - d[0], v[1] - d[1], v[2] - d[2]};
  };
  return Dot(from_d(a), Cross(from_d(b), from_d(c)));
}

struct Box {
  Vertex low, high;

  bool Meets(const Box& other) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (high[axis] < other.low[axis] || other.high[axis] < low[axis]) return false;
    }
    return true;
  }
};

// A triangle in a cell of the grid below; sorted by cell.
struct Entry {
  uint64_t cell;
  uint32_t triangle;

  friend auto operator<=>(const Entry&, const Entry&) = default;
};

class Crossings {
 public:
  Crossings(const Surface& surface, const exec::Context& context)
      : surface_(surface), poll_(context) {
    boxes_.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) boxes_.push_back(BoxOf(t));
  }

  CrossingCount Count() {
    const std::vector<Entry> entries = Entries();
    CrossingCount crossings;
    for (size_t n = 0; n < entries.size(); ++n) {
      const auto [cell, triangle] = entries[n];
      for (size_t m = n + 1; m < entries.size() && entries[m].cell == cell; ++m) {
        if (poll_.Stopped()) return crossings;
        const uint32_t other = entries[m].triangle;
        const bool counts = boxes_[triangle].Meets(boxes_[other]) &&
                            FirstCellOfBoth(triangle, other) == cell && Cross(triangle, other);
        if (!counts) continue;
        const std::vector<uint32_t>& parts = surface_.component_of;
        ++(parts[triangle] == parts[other] ? crossings.within_parts : crossings.between_parts);
      }
    }
    return crossings;
  }

 private:
  Box BoxOf(const Triangle& t) const {
    Box box = {surface_.vertices[t[0]], surface_.vertices[t[0]]};
    for (const uint32_t v : t) {
      for (size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], surface_.vertices[v][axis]);
        box.high[axis] = std::max(box.high[axis], surface_.vertices[v][axis]);
      }
    }
    return box;
  }

  // Cells twice as wide as the triangles' boxes are on average, or wider where a few large
  // triangles would have too many.
  std::vector<Entry> Entries() {
    double sum = 0;
    for (const Box& box : boxes_) {
      for (size_t axis = 0; axis < 3; ++axis) sum += box.high[axis] - box.low[axis];
    }
    const double mean = sum / 3 / static_cast<double>(std::max<size_t>(boxes_.size(), 1));
    cell_ = std::clamp(2 * mean, 1.0 / (1 << 20), 1.0);
    while (cell_ < 1 && EntryCount() > 16 * static_cast<double>(boxes_.size())) cell_ *= 2;
    std::vector<Entry> entries;
    for (uint32_t t = 0; t < boxes_.size(); ++t) {
      ForEachCell(boxes_[t], [&](uint64_t cell) { entries.push_back({cell, t}); });
    }
    std::ranges::sort(entries);
    return entries;
  }

  double EntryCount() const {
    double count = 0;
    for (const Box& box : boxes_) {
      double cells = 1;
      for (size_t axis = 0; axis < 3; ++axis) {
        cells *= static_cast<double>(Place(box.high[axis]) - Place(box.low[axis]) + 1);
      }
      count += cells;
    }
    return count;
  }

  // Coordinates are 0 to 1, so a place has 21 bits.
  uint64_t Place(double coordinate) const { return static_cast<uint64_t>(coordinate / cell_); }

  template <typename Visit>
  void ForEachCell(const Box& box, Visit visit) const {
    for (uint64_t z = Place(box.low[2]); z <= Place(box.high[2]); ++z) {
      for (uint64_t y = Place(box.low[1]); y <= Place(box.high[1]); ++y) {
        for (uint64_t x = Place(box.low[0]); x <= Place(box.high[0]); ++x) {
          visit(z << 42 | y << 21 | x);
        }
      }
    }
  }

  // So that a pair counts once. Needs: the boxes meet.
  uint64_t FirstCellOfBoth(uint32_t a, uint32_t b) const {
    const auto place = [&](size_t axis) {
      return Place(std::max(boxes_[a].low[axis], boxes_[b].low[axis]));
    };
    return place(2) << 42 | place(1) << 21 | place(0);
  }

  using Corners = std::array<const Vertex*, 3>;
  Corners CornersOf(uint32_t triangle) const {
    const Triangle& t = surface_.triangles[triangle];
    return {&surface_.vertices[t[0]], &surface_.vertices[t[1]], &surface_.vertices[t[2]]};
  }

  // Guigue and Devillers (2003), without degenerate cases: each triangle crosses the plane of the
  // other, and the two segments on the line of both planes overlap. Each triangle is turned so that
  // its first corner is alone on its side, and the other one so that this side is the positive one.
  bool Cross(uint32_t a, uint32_t b) const {
    Corners s = CornersOf(a), t = CornersOf(b);
    if (!TurnToCross(s, t) || !TurnToCross(t, s)) return false;
    return Volume6(*s[0], *s[1], *t[0], *t[1]) < 0 && Volume6(*s[0], *s[2], *t[2], *t[0]) < 0;
  }

  // Returns whether the triangle crosses the plane of the other one.
  static bool TurnToCross(Corners& triangle, Corners& other) {
    std::array<double, 3> sides;
    for (size_t n = 0; n < 3; ++n) {
      sides[n] = Volume6(*other[0], *other[1], *other[2], *triangle[n]);
    }
    const auto count = [&](auto is) { return std::ranges::count_if(sides, is); };
    const auto above = count([](double s) { return s > 0; });
    const auto below = count([](double s) { return s < 0; });
    if (above == 0 || below == 0) return false;
    const bool is_above = above == 1;
    size_t first = 0;
    while (is_above ? !(sides[first] > 0) : !(sides[first] < 0)) ++first;
    std::rotate(triangle.begin(), triangle.begin() + static_cast<ptrdiff_t>(first), triangle.end());
    if (!is_above) std::swap(other[1], other[2]);
    return true;
  }

  const Surface& surface_;
  StopPoll poll_;
  std::vector<Box> boxes_;
  double cell_ = 1;
};

}  // namespace

absl::StatusOr<CrossingCount> CountCrossings(const Surface& surface, const exec::Context& context) {
  const CrossingCount count = Crossings(surface, context).Count();
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return count;
}

}  // namespace bccskel
