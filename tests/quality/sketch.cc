#include "tests/quality/sketch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/import/shapes/random.h"

namespace bccskel::quality {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The signed function of a piece: below 0 inside, and never larger than the distance to the
// surface, inside and out.
class PieceFunction {
 public:
  explicit PieceFunction(const Piece& piece)
      : piece_(piece), axis_(piece.to - piece.from), square_length_(Dot(axis_, axis_)) {
    slope_ = piece.from_radius - piece.to_radius;
    if (square_length_ > 0) along_ = (1 / std::sqrt(square_length_)) * axis_;
    across_ = Cross(piece.normal, along_);
  }

  double At(Vector p) const {
    double value = piece_.square ? Block(p) : Swept(p) / piece_.flat;
    if (piece_.first_cut) value = std::max(value, Dot(*piece_.first_cut - p, along_));
    if (piece_.last_cut) value = std::max(value, Dot(p - *piece_.last_cut, along_));
    return value;
  }

 private:
  double Block(Vector p) const {
    const Vector way = p - piece_.from;
    const double height = Dot(way, along_);
    return std::max({std::abs(Dot(way, piece_.normal)) - piece_.from_radius / piece_.flat,
                     std::abs(Dot(way, across_)) - piece_.from_radius, -height,
                     height - std::sqrt(square_length_)});
  }

  // The hull of two balls, after stretching the flat direction.
  double Swept(Vector p) const {
    Vector way = p - piece_.from;
    if (piece_.flat != 1) way = way + (piece_.flat - 1) * Dot(way, piece_.normal) * piece_.normal;
    const double lean = square_length_ - slope_ * slope_;
    if (lean <= 0) {  // one ball holds the other
      return std::min(Length(way) - piece_.from_radius, Length(way - axis_) - piece_.to_radius);
    }
    const double y = Dot(way, axis_), z = y - square_length_;
    const Vector off = square_length_ * way - y * axis_;
    const double x2 = Dot(off, off), y2 = y * y * square_length_, z2 = z * z * square_length_;
    const double bend = std::copysign(slope_ * slope_ * x2, slope_);
    if (std::copysign(lean * z2, z) > bend) {
      return std::sqrt(x2 + z2) / square_length_ - piece_.to_radius;
    }
    if (std::copysign(lean * y2, y) < bend) {
      return std::sqrt(x2 + y2) / square_length_ - piece_.from_radius;
    }
    return (std::sqrt(x2 * lean / square_length_) + y * slope_) / square_length_ -
           piece_.from_radius;
  }

  const Piece piece_;
  const Vector axis_;
  const double square_length_;
  double slope_ = 0;
  Vector along_ = {1, 0, 0};
  Vector across_;
};

// Between -1 and 1.
double Waves(Vector p) {
  constexpr std::array<Vector, 5> kWaves = {
      {{0.9, 0.2, -0.3}, {-0.3, 0.7, 0.5}, {0.2, -0.6, 0.8}, {0.5, 0.5, 0.4}, {-0.7, 0.3, 0.6}}};
  double sum = 0;
  for (const Vector& wave : kWaves) sum += std::sin(Dot(wave, p));
  return sum / kWaves.size();
}

class Sampler {
 public:
  Sampler(const Sketch& sketch, Grid grid,
          const std::function<void(int32_t, int32_t, int32_t)>& visit)
      : rough_(sketch.rough),
        frequency_(6.3 / sketch.wavelength),
        step_(grid == Grid::kBcc ? 2 : 1),
        visit_(visit) {
    for (const Piece& piece : sketch.pieces) functions_.emplace_back(piece);
  }

  void Run(int32_t edge) {
    std::vector<uint32_t> all(functions_.size());
    for (uint32_t n = 0; n < all.size(); ++n) all[n] = n;
    VisitBox({0, 0, 0}, edge, all);
  }

 private:
  static constexpr int32_t kLeastEdge = 4;

  void VisitBox(const std::array<int32_t, 3>& low, int32_t edge,
                const std::vector<uint32_t>& pieces) {
    const double half = (edge - 1) / 2.0;
    const double reach = half * std::sqrt(3.0) + rough_;
    const Vector middle = {low[0] + half, low[1] + half, low[2] + half};
    std::vector<uint32_t> near;
    bool full = false;
    for (const uint32_t n : pieces) {
      const double value = functions_[n].At(middle);
      if (value <= reach) near.push_back(n);
      full = full || value < -reach;
    }
    if (near.empty()) return;
    if (full || edge <= kLeastEdge) return VisitPoints(low, edge, full, near);
    const int32_t part = edge / 2;
    for (int corner = 0; corner < 8; ++corner) {
      VisitBox({low[0] + (corner & 1) * part, low[1] + (corner >> 1 & 1) * part,
                low[2] + (corner >> 2) * part},
               part, near);
    }
  }

  void VisitPoints(const std::array<int32_t, 3>& low, int32_t edge, bool full,
                   const std::vector<uint32_t>& near) {
    for (int32_t z = low[2]; z < low[2] + edge; ++z) {
      const int32_t first = step_ == 2 ? z & 1 : 0;  // boxes begin at even numbers
      for (int32_t y = low[1] + first; y < low[1] + edge; y += step_) {
        for (int32_t x = low[0] + first; x < low[0] + edge; x += step_) {
          if (full || Holds({1.0 * x, 1.0 * y, 1.0 * z}, near)) visit_(x, y, z);
        }
      }
    }
  }

  bool Holds(Vector p, const std::vector<uint32_t>& near) const {
    const double limit = rough_ == 0 ? 0 : rough_ * Waves(frequency_ * p);
    return std::ranges::any_of(near, [&](uint32_t n) { return functions_[n].At(p) < limit; });
  }

  const double rough_;
  const double frequency_;
  const int32_t step_;
  const std::function<void(int32_t, int32_t, int32_t)>& visit_;
  std::vector<PieceFunction> functions_;
};

struct Box {
  Vector low = {kInfinity, kInfinity, kInfinity};
  Vector high = {-kInfinity, -kInfinity, -kInfinity};
};

Box BoxOf(const Sketch& sketch) {
  Box box;
  const auto include = [&](Vector p, double radius) {
    radius += sketch.rough;
    box.low = {std::min(box.low.x, p.x - radius), std::min(box.low.y, p.y - radius),
               std::min(box.low.z, p.z - radius)};
    box.high = {std::max(box.high.x, p.x + radius), std::max(box.high.y, p.y + radius),
                std::max(box.high.z, p.z + radius)};
  };
  for (const Piece& piece : sketch.pieces) {
    include(piece.from, (piece.square ? std::sqrt(2) : 1) * piece.from_radius);
    include(piece.to, (piece.square ? std::sqrt(2) : 1) * piece.to_radius);
  }
  return box;
}

template <typename Change>  // Vector(Vector, bool is_place)
Sketch Changed(Sketch sketch, Change change) {
  const auto change_piece = [&](Piece& piece) {
    piece.from = change(piece.from, true);
    piece.to = change(piece.to, true);
    piece.normal = change(piece.normal, false);
    if (piece.first_cut) piece.first_cut = change(*piece.first_cut, true);
    if (piece.last_cut) piece.last_cut = change(*piece.last_cut, true);
  };
  std::ranges::for_each(sketch.pieces, change_piece);
  std::ranges::for_each(sketch.line, change_piece);
  for (Tip& tip : sketch.tips) {
    tip.inner = change(tip.inner, true);
    tip.outer = change(tip.outer, true);
  }
  return sketch;
}

}  // namespace

Piece Reversed(Piece piece) {
  std::swap(piece.from, piece.to);
  std::swap(piece.from_radius, piece.to_radius);
  std::swap(piece.first_cut, piece.last_cut);
  return piece;
}

Piece CutAtEnd(Piece piece, double beyond) {
  const Vector way = piece.to - piece.from;
  const double growth = (piece.to_radius - piece.from_radius) / Length(way);
  piece.last_cut = piece.to + beyond * Unit(way);
  if (beyond > 0) return piece;
  // Its own cap would be in the way.
  const double more = piece.to_radius;
  piece.to = piece.to + more * Unit(way);
  piece.to_radius = std::max(piece.to_radius + more * growth, 0.01);
  return piece;
}

void Sketch::AddLimb(const Piece& piece, double out) {
  pieces.push_back(piece);
  AddTipOf(piece, out);
}

void Sketch::AddTipOf(const Piece& piece, double out) {
  constexpr double kThinnest = 2;  // a ridge cannot be seen in what is thinner
  const Vector way = piece.to - piece.from, along = Unit(way);
  const double radius = piece.to_radius;
  Tip tip = {piece.to, piece.to, std::max({5.0, 1.2 * radius, out / 2})};
  if (piece.last_cut) {
    tip.outer = *piece.last_cut;
    tip.inner = tip.outer - radius * along;
  } else if (radius < kThinnest && piece.from_radius > kThinnest) {
    const double t = (piece.from_radius - kThinnest) / (piece.from_radius - radius);
    tip.inner = piece.from + t * way;
  } else {
    tip.outer = piece.to + radius * (1 - 1 / (piece.flat * piece.flat)) * along;
  }
  tips.push_back(tip);
}

Sketch Turned(Sketch sketch, const Frame& frame) {
  return Changed(std::move(sketch), [&](Vector v, bool) { return frame.Turn(v); });
}

Sketch Moved(Sketch sketch, double margin, uint64_t seed) {
  shapes::Random random(seed);
  const Vector bit = {random.Between(0, 2), random.Between(0, 2), random.Between(0, 2)};
  const Vector shift = Vector{margin, margin, margin} + bit - BoxOf(sketch).low;
  return Changed(std::move(sketch), [&](Vector v, bool place) { return place ? v + shift : v; });
}

void ForEachPoint(const Sketch& sketch, Grid grid,
                  const std::function<void(int32_t, int32_t, int32_t)>& visit) {
  const Box box = BoxOf(sketch);
  int32_t edge = 8;
  while (edge <= std::max({box.high.x, box.high.y, box.high.z})) edge *= 2;
  Sampler(sketch, grid, visit).Run(edge);
}

uint64_t CountPoints(const Sketch& sketch, Grid grid) {
  uint64_t count = 0;
  ForEachPoint(sketch, grid, [&](int32_t, int32_t, int32_t) { ++count; });
  return count;
}

absl::StatusOr<Volume> SampleOnBcc(const Sketch& sketch) {
  const Box box = BoxOf(sketch);
  const auto cells = [](double high) { return static_cast<int32_t>(high / 2) + 3; };
  VolumeBuilder builder({cells(box.high.x), cells(box.high.y), cells(box.high.z)},
                        {.spacing = {2, 2, 2}});
  ForEachPoint(sketch, Grid::kBcc, [&](int32_t x, int32_t y, int32_t z) {
    builder.Add({x, y, z});
  });
  return std::move(builder).Build();
}

VoxelMask SampleOnVoxels(const Sketch& sketch) {
  const Box box = BoxOf(sketch);
  const auto voxels = [](double high) { return static_cast<int32_t>(high) + 3; };
  VoxelMask mask({.nx = voxels(box.high.x), .ny = voxels(box.high.y), .nz = voxels(box.high.z)});
  ForEachPoint(sketch, Grid::kCubic, [&](int32_t x, int32_t y, int32_t z) {
    mask.Flip({x, y, z});
  });
  return mask;
}

double DistanceToSegment(Vector p, Vector a, Vector b) {
  const Vector way = b - a;
  const double square = Dot(way, way);
  const double t = square > 0 ? std::clamp(Dot(p - a, way) / square, 0.0, 1.0) : 0;
  return Length(p - a - t * way);
}

}  // namespace bccskel::quality
