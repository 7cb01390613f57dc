#include "tests/quality/known_figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/exec/status_macros.h"
#include "core/import/shapes/branching.h"
#include "core/import/shapes/random.h"
#include "core/import/shapes/rasterize.h"

namespace bccskel::quality {

using shapes::Block;
using shapes::RoundCone;
using shapes::Solid;
using shapes::Spheroid;
using shapes::Unit;
using shapes::Vector;

namespace {

bool Same(Vector a, Vector b) { return Dot(a - b, a - b) == 0; }

// A figure made of round cones around its center line. Tips are where a single piece ends.
KnownFigure OfPieces(std::string name, std::vector<RoundCone> pieces) {
  KnownFigure figure{
      .name = std::move(name), .solids = {pieces.begin(), pieces.end()}, .line = pieces};
  for (const RoundCone& piece : pieces) {
    const auto touches = [&](const RoundCone& other) {
      return Same(other.from, piece.to) || (&other != &piece && Same(other.to, piece.to));
    };
    if (std::ranges::none_of(pieces, touches)) figure.tips.push_back(piece);
  }
  return figure;
}

// The first piece's `from` is a tip as well.
KnownFigure WithTipAtTheStart(KnownFigure figure) {
  const RoundCone& first = figure.line.front();
  figure.tips.push_back({first.to, first.from, first.to_radius, first.from_radius});
  return figure;
}

// A chain of round cones through curve(t), t from 0 to 1, with radius(t).
template <typename Curve, typename Radius>
std::vector<RoundCone> Chain(int pieces, Curve curve, Radius radius) {
  std::vector<RoundCone> chain;
  for (int n = 0; n < pieces; ++n) {
    const double from = static_cast<double>(n) / pieces, to = static_cast<double>(n + 1) / pieces;
    chain.push_back({curve(from), curve(to), radius(from), radius(to)});
  }
  return chain;
}

template <typename Curve>
KnownFigure Ring(std::string name, int pieces, Curve curve, double radius) {
  std::vector<RoundCone> chain = Chain(pieces, curve, [&](double) { return radius; });
  chain.back().to = chain.front().from;
  KnownFigure figure = OfPieces(std::move(name), chain);
  figure.loops = 1;
  return figure;
}

Vector OnCircle(double t, double radius) {
  const double angle = 2 * std::numbers::pi * t;
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

Vector Trefoil(double t) {
  const double angle = 2 * std::numbers::pi * t;
  return {std::sin(angle) + 2 * std::sin(2 * angle), std::cos(angle) - 2 * std::cos(2 * angle),
          -std::sin(3 * angle)};
}

Vector Helix(double t) {
  const double angle = 6 * std::numbers::pi * t;
  return {3 * std::cos(angle), 3 * std::sin(angle), 9 * t};
}

Vector Wave(double t) { return {16 * t, 2 * std::sin(5 * t), 1.5 * std::cos(4 * t)}; }

// Grown branches: every one begins where another ends, but side branches leave the trunk.
KnownFigure Tree(std::string name, const shapes::BranchingPlan& plan, uint64_t seed) {
  std::vector<RoundCone> pieces;
  for (const Solid& solid : shapes::GrowBranches(plan, seed)) {
    pieces.push_back(std::get<RoundCone>(solid));
  }
  KnownFigure figure = WithTipAtTheStart(OfPieces(std::move(name), pieces));
  figure.forks = (1 << plan.levels) - 1 + plan.side_branches;
  return figure;
}

KnownFigure Star() {
  std::vector<RoundCone> arms;
  constexpr Vector kWays[] = {
      {1, 0, 0}, {-0.5, 0.8, 0.3}, {-0.4, -0.8, 0.4}, {0.1, 0.2, 1}, {0.3, 0.5, -0.9}};
  for (size_t n = 0; n < std::size(kWays); ++n) {
    const double radius = 1.1 - 0.15 * static_cast<double>(n);
    arms.push_back({{0, 0, 0}, 9.0 * Unit(kWays[n]), radius, radius});
  }
  KnownFigure figure = OfPieces("star", arms);
  figure.forks = 1;
  return figure;
}

KnownFigure Ladder() {
  std::vector<RoundCone> pieces;
  for (double side : {-2.5, 2.5}) {
    for (int n = 0; n < 4; ++n) {
      const double from = 5.0 * n - 10, to = from + 5;
      pieces.push_back({{from, side, 0}, {to, side, 0}, 0.8, 0.8});
    }
  }
  for (int n = 0; n < 3; ++n) {
    const double at = 5.0 * n - 5;
    pieces.push_back({{at, -2.5, 0}, {at, 2.5, 0}, 0.6, 0.6});
  }
  KnownFigure figure = OfPieces("ladder", pieces);
  // The rails begin with tips, too.
  for (size_t n : {size_t{0}, size_t{4}}) {
    figure.tips.push_back({pieces[n].to, pieces[n].from, 0.8, 0.8});
  }
  figure.forks = 6;
  figure.loops = 2;
  return figure;
}

// Thin limbs on a thick body.
KnownFigure Hedgehog() {
  std::vector<RoundCone> pieces = {{{-7, 0, 0}, {-3, 0, 0}, 2.5, 2.5},
                                   {{-3, 0, 0}, {2, 0, 0}, 2.5, 2.5},
                                   {{2, 0, 0}, {7, 0, 0}, 2.5, 2.5},
                                   {{-3, 0, 0}, {-3, 8, 1}, 0.5, 0.5},
                                   {{2, 0, 0}, {2.5, -5, 7}, 0.7, 0.4}};
  KnownFigure figure = WithTipAtTheStart(OfPieces("limbs", pieces));
  figure.forks = 2;
  return figure;
}

// A spheroid's medial axis ends where its cap's curvature is centered.
RoundCone TipOf(const Spheroid& s, double way) {
  const double reach = s.along - s.across * s.across / s.along;
  return {s.center, s.center + way * reach * s.axis, s.across, s.across * s.across / s.along};
}

// A body, a head on a neck, a tail and four legs: six tips.
KnownFigure Horse() {
  KnownFigure figure{.name = "horse"};
  figure.solids = {Spheroid{{0, 0, 0}, {1, 0, 0}, 1.1, 0.42}};
  const auto add = [&](const Spheroid& part, double way) {
    figure.solids.push_back(part);
    figure.tips.push_back(TipOf(part, way));
  };
  add(Spheroid{{1.2, 0, 0.55}, Unit({0.7, 0, 0.6}), 0.75, 0.2}, 1);
  add(Spheroid{{-1.25, 0, -0.1}, Unit({-0.8, 0, -0.5}), 0.6, 0.1}, 1);
  for (double side : {-1.0, 1.0}) {
    for (double x : {-0.65, 0.65}) {
      add(Spheroid{{x, side * 0.26, -0.75}, {0, 0, 1}, 0.7, 0.14}, -1);
    }
  }
  return figure;
}

// A bar along x, turned later or not. The center line ends with the last inscribed ball.
KnownFigure Bar(std::string name, double length, double width, double height) {
  const double half = (length - width) / 2;
  KnownFigure figure{.name = std::move(name),
                     .solids = {Block{{length / 2, width / 2, height / 2}}},
                     .line = {{{-half, 0, 0}, {half, 0, 0}, width / 2, width / 2}}};
  figure.tips = figure.line;
  return WithTipAtTheStart(std::move(figure));
}

// In lattice units, along the axes. The rasterizer leaves 4 units before it, so the axis of a bar 8
// wide and high lies in a row of points, and of one 8 wide and 10 high as far from rows as can be.
KnownFigure AlignedBar(std::string name, double length, double width, double height) {
  KnownFigure figure = Bar(std::move(name), length, width, height);
  figure.turns = false;
  figure.scale = 1;
  return figure;
}

KnownFigure Cube() {
  KnownFigure figure{.name = "cube", .solids = {Block{{1, 1, 1}}}};
  figure.turns = false;
  return figure;
}

}  // namespace

std::vector<KnownFigure> KnownFigures() {
  const auto one = [](double) { return 1.0; };
  const auto swelling = [](double t) { return 1 + 0.35 * std::sin(14 * t); };
  const auto straight = [](double t) { return Vector{18 * t, 0, 0}; };
  return {
      WithTipAtTheStart(OfPieces("tube", Chain(1, straight, one))),
      Ring(
          "torus", 256, [](double t) { return OnCircle(t, 2.6); }, 1),
      Tree("tree", {.levels = 5, .side_branches = 1, .taper = shapes::Taper::kToTheNextBranch}, 0),
      Horse(),
      Bar("bar", 12, 1, 1),
      WithTipAtTheStart(OfPieces("helix", Chain(128, Helix, one))),
      WithTipAtTheStart(OfPieces("wave", Chain(64, Wave, swelling))),
      Ring(
          "ring", 256, [](double t) { return OnCircle(t, 6); }, 1),
      Ring("knot", 256, Trefoil, 0.4),
      Tree("coral", {.levels = 4, .length_ratio = 0.9, .radius_ratio = 0.85}, 7),
      Star(),
      Ladder(),
      Hedgehog(),
      AlignedBar("bar in a row", 200, 8, 8),
      AlignedBar("bar between rows", 200, 8, 10),
      Cube(),
  };
}

Frame RandomFrame(uint64_t seed) {
  shapes::Random random(seed ^ 0x517cc1b727220a95);
  Frame frame;
  frame.x = Unit(random.InUnitBall());
  frame.y = Unit(Cross(frame.x, random.InUnitBall()));
  frame.z = Cross(frame.x, frame.y);
  return frame;
}

namespace {

RoundCone TurnedCone(const RoundCone& c, const Frame& frame) {
  return {frame.Turn(c.from), frame.Turn(c.to), c.from_radius, c.to_radius};
}

struct TurnSolid {
  const Frame& frame;

  Solid operator()(const Spheroid& s) const {
    return Spheroid{frame.Turn(s.center), frame.Turn(s.axis), s.along, s.across};
  }
  Solid operator()(const RoundCone& c) const { return TurnedCone(c, frame); }
  Solid operator()(const Block& b) const {
    return Block{b.half_edges, frame.Turn(b.first), frame.Turn(b.second)};
  }
  template <typename Round>
  Solid operator()(const Round& solid) const {
    return solid;
  }
};

Vector LowCorner(std::span<const Solid> solids) {
  Vector low = BoundsOf(solids[0]).low;
  for (const Solid& solid : solids) {
    const Vector other = BoundsOf(solid).low;
    low = {std::min(low.x, other.x), std::min(low.y, other.y), std::min(low.z, other.z)};
  }
  return low;
}

}  // namespace

KnownFigure Turned(const KnownFigure& figure, const Frame& frame) {
  KnownFigure turned = figure;
  for (Solid& solid : turned.solids) solid = std::visit(TurnSolid{frame}, solid);
  for (RoundCone& piece : turned.line) piece = TurnedCone(piece, frame);
  for (RoundCone& tip : turned.tips) tip = TurnedCone(tip, frame);
  return turned;
}

absl::StatusOr<PlacedFigure> Place(const KnownFigure& figure, uint64_t points) {
  constexpr int kTries = 8;
  PlacedFigure placed{.figure = figure, .object = {}, .scale = figure.scale};
  if (figure.scale == 0) placed.scale = 8;
  for (int n = 0; n < kTries; ++n) {
    BCCSKEL_ASSIGN_OR_RETURN(placed.object, shapes::Rasterize(figure.solids, placed.scale));
    const double ratio =
        static_cast<double>(placed.object.PointCount()) / static_cast<double>(points);
    if (figure.scale != 0 || std::abs(ratio - 1) < 0.005) break;
    placed.scale /= std::cbrt(ratio);
  }
  constexpr double kMargin = 4;  // of the rasterizer
  placed.shift = Vector{kMargin, kMargin, kMargin} - placed.scale * LowCorner(figure.solids);
  return placed;
}

}  // namespace bccskel::quality
