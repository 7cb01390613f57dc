#include <algorithm>
#include <numeric>

#include "tests/quality/wild_drawings.h"

namespace bccskel::quality {
namespace {

// Between straight pieces, from places along the first.
double DistanceBetweenPieces(const Piece& a, const Piece& b) {
  constexpr int kPlaces = 8;
  double nearest = DistanceToSegment(a.to, b.from, b.to);
  for (int n = 0; n < kPlaces; ++n) {
    const double t = static_cast<double>(n) / kPlaces;
    nearest = std::min(nearest, DistanceToSegment(a.from + t * (a.to - a.from), b.from, b.to));
  }
  return nearest;
}

// Dendrites, each a chain of pieces that leads away from the body and keeps off all others.
class Arbor {
 public:
  Arbor(Pen pen, double step) : pen_(pen), step_(step) {}

  // Returns whether anything grew.
  bool Grow(Piece last, double length, int forks) {
    const size_t before = sketch_.pieces.size();
    const double whole = length;
    for (; length > 0; length -= step_) {
      if (forks > 0 && length < 0.6 * whole && Fork(last, length, forks - 1)) return true;
      const std::optional<Piece> next = Next(last, 0.35);
      if (!next) break;
      sketch_.pieces.push_back(last = *next);
    }
    if (sketch_.pieces.size() == before) return false;
    sketch_.AddTipOf(last, std::max(whole - length, step_));
    return true;
  }

  Sketch Finish() && { return std::move(sketch_); }

 private:
  // Two pieces that leave to different sides.
  bool Fork(const Piece& last, double length, int forks) {
    std::optional<Piece> first = Next(last, 0.8);
    if (!first) return false;
    const Vector ahead = Unit(last.to - last.from), way = Unit(first->to - first->from);
    Piece second = *first;
    const Vector mirrored = 2 * Dot(way, ahead) * ahead - way;
    second.to = second.from + step_ * mirrored;
    if (Dot(way, mirrored) > 0.6 || !IsFree(second, last)) return false;
    sketch_.pieces.push_back(*first);
    sketch_.pieces.push_back(second);
    for (const Piece& start : {*first, second}) {
      if (!Grow(start, length, forks)) sketch_.AddTipOf(start, step_);
    }
    return true;
  }

  std::optional<Piece> Next(const Piece& last, double wander) {
    const Vector ahead = Unit(last.to - last.from), out = Unit(last.to);
    for (int tries = 0; tries < 20; ++tries) {
      const Vector way = Unit(ahead + 0.2 * out + wander * pen_.random.InUnitBall());
      const double radius = last.to_radius;
      const Piece next = {last.to, last.to + step_ * way, radius, std::max(radius * 0.98, 1.5)};
      if (IsFree(next, last)) return next;
    }
    return std::nullopt;
  }

  bool IsFree(const Piece& piece, const Piece& last) const {
    if (Length(piece.to) < Length(piece.from)) return false;
    Piece outer = piece;  // its first half may be near the place that it comes from
    outer.from = 0.5 * (piece.from + piece.to);
    return std::ranges::none_of(sketch_.pieces, [&](const Piece& other) {
      const bool is_last = Length(other.to - last.to) == 0;
      return !is_last && DistanceBetweenPieces(outer, other) < 2.5 * piece.from_radius + 2;
    });
  }

  Pen pen_;
  const double step_;
  Sketch sketch_;
};

std::vector<Vector> ScatteredPlaces(Pen& pen, size_t count, double edge, double apart) {
  std::vector<Vector> places;
  for (int tries = 0; places.size() < count && tries < 20'000; ++tries) {
    const Vector place = {pen.Between(0, edge), pen.Between(0, edge), pen.Between(0, edge)};
    const auto near = [&](Vector other) { return Length(place - other) < apart; };
    if (std::ranges::none_of(places, near)) places.push_back(place);
  }
  return places;
}

// Short ways first; each keeps off what it does not meet, and leaves at an angle from what it does.
class Tubes {
 public:
  Tubes(std::vector<Vector> places, double radius, int largest_degree)
      : places_(std::move(places)),
        radius_(radius),
        largest_degree_(largest_degree),
        degrees_(places_.size()) {}

  void Connect() {
    std::vector<std::pair<double, std::pair<size_t, size_t>>> ways;
    for (size_t a = 0; a < places_.size(); ++a) {
      for (size_t b = a + 1; b < places_.size(); ++b) {
        ways.push_back({Length(places_[a] - places_[b]), {a, b}});
      }
    }
    std::ranges::sort(ways);
    for (const auto& [length, ends] : ways) {
      if (length < 24 * radius_ && Fits(ends.first, ends.second)) Add(ends);
    }
  }

  // The largest connected part.
  Sketch Finish() && {
    std::vector<size_t> part(places_.size());
    std::iota(part.begin(), part.end(), 0);
    for (size_t round = 0; round < places_.size(); ++round) {
      for (const auto& [a, b] : tubes_) part[a] = part[b] = std::min(part[a], part[b]);
    }
    std::vector<int> sizes(places_.size());
    for (const size_t p : part) ++sizes[p];
    const auto largest = static_cast<size_t>(std::ranges::max_element(sizes) - sizes.begin());
    Sketch sketch{.junctions = 0, .loops = 1 - sizes[largest]};
    for (const auto& [a, b] : tubes_) {
      if (part[a] != largest) continue;
      ++sketch.loops;
      const Piece piece = PieceOf(a, b);
      sketch.pieces.push_back(piece);
      if (degrees_[b] == 1) sketch.AddTipOf(piece, Length(piece.to - piece.from) / 2);
      if (degrees_[a] == 1) sketch.AddTipOf(Reversed(piece), Length(piece.to - piece.from) / 2);
    }
    for (size_t n = 0; n < places_.size(); ++n) {
      sketch.junctions += part[n] == largest && degrees_[n] > 2 ? 1 : 0;
    }
    sketch.line = sketch.pieces;
    return sketch;
  }

 private:
  Piece PieceOf(size_t a, size_t b) const { return {places_[a], places_[b], radius_, radius_}; }

  bool Fits(size_t a, size_t b) const {
    if (std::max(degrees_[a], degrees_[b]) >= largest_degree_) return false;
    const Piece piece = PieceOf(a, b);
    return std::ranges::all_of(tubes_, [&](const auto& other) {
      const auto& [c, d] = other;
      const bool at_a = a == c || a == d, at_b = b == c || b == d;
      if (!at_a && !at_b) return DistanceBetweenPieces(piece, PieceOf(c, d)) > 4 * radius_;
      const size_t meet = at_a ? a : b, far = at_a ? b : a, other_far = meet == c ? d : c;
      constexpr double kLargestCosine = 0.6;
      return Dot(Unit(places_[far] - places_[meet]), Unit(places_[other_far] - places_[meet])) <
             kLargestCosine;
    });
  }

  void Add(std::pair<size_t, size_t> ends) {
    tubes_.push_back(ends);
    ++degrees_[ends.first];
    ++degrees_[ends.second];
  }

  const std::vector<Vector> places_;
  const double radius_;
  const int largest_degree_;
  std::vector<int> degrees_;
  std::vector<std::pair<size_t, size_t>> tubes_;
};

}  // namespace

Sketch Soma(Pen pen, const WildFigure::Values& v) {
  const double s = pen.size;
  Arbor arbor(pen, std::max(s / 4, 10.0));
  std::vector<Vector> ways;
  while (static_cast<double>(ways.size()) < v[0]) {
    const Vector way = pen.Direction();
    const auto near = [&](Vector other) { return Dot(way, other) > 0.75; };
    if (std::ranges::none_of(ways, near)) ways.push_back(way);
  }
  for (const Vector& way : ways) {
    const double radius = pen.Between(v[2], v[3]);
    arbor.Grow({{0, 0, 0}, s * way, radius, radius}, pen.Between(0.7, 1) * v[1] * s, 2);
  }
  Sketch sketch = std::move(arbor).Finish();
  sketch.pieces.push_back({{0, 0, 0}, {0, 0, 0}, s, s});
  return sketch;
}

Sketch Network(Pen pen, const WildFigure::Values& v) {
  const double r = pen.size;
  Tubes tubes(ScatteredPlaces(pen, static_cast<size_t>(v[0]), v[1] * r, 8 * r), r,
              static_cast<int>(v[2]));
  tubes.Connect();
  return std::move(tubes).Finish();
}

Sketch Round(Pen pen, const WildFigure::Values&) {
  std::vector<KnownFigure> figures = KnownFigures();
  std::erase_if(figures, [](const KnownFigure& figure) {
    const auto is_cone = [](const shapes::Solid& solid) {
      return std::holds_alternative<shapes::RoundCone>(solid);
    };
    return !std::ranges::all_of(figure.solids, is_cone);
  });
  const auto chosen = static_cast<size_t>(pen.Between(0, static_cast<double>(figures.size())));
  const KnownFigure& figure = figures[chosen];
  const auto piece_of = [&](const shapes::RoundCone& c) {
    return Piece{pen.size * c.from, pen.size * c.to, pen.size * c.from_radius,
                 pen.size * c.to_radius};
  };
  Sketch sketch;
  for (const shapes::RoundCone& cone : figure.line) sketch.line.push_back(piece_of(cone));
  sketch.pieces = sketch.line;
  for (const shapes::RoundCone& tip : figure.tips) {
    sketch.AddTipOf(piece_of(tip), 2 * pen.size * tip.to_radius);
  }
  return sketch;
}

}  // namespace bccskel::quality
