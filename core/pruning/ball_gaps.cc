#include "core/pruning/ball_gaps.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace bccskel {
namespace {

constexpr int kSmallest = 3;  // binary logarithm of the smallest edge: a quarter of a brick's

// The bits of a quarter of a brick's layer along x.
constexpr uint64_t kQuarter = 0x000F'000F'000F'000F;

}  // namespace

BallGaps::BallGaps(const Volume& object, const ThinSet& set, int32_t edge, StopPoll& poll)
    : object_(object), scale_(set.scale()), bits_(std::countr_zero(static_cast<uint32_t>(edge))) {
  FindCubes(object);
  std::vector<LatticePoint> points;
  set.ForEachPoint([&](LatticePoint p) { points.push_back(p); });
  std::ranges::sort(points);
  for (LatticePoint p : points) {
    if (poll.Stopped()) return;
    const uint32_t* cube = index_.Find(CubeOf(p));
    if (cube != nullptr) Offer(*cube, {p, set.RadiusOf(p)});
  }
  Spread(poll);
}

void BallGaps::FindCubes(const Volume& object) {
  const int shift = bits_ - kSmallest;
  for (size_t n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
    const BrickBits& bits = object.bricks()[n];
    for (int half = 0; half < 2; ++half) {
      uint64_t any = 0;
      for (int layer = 0; layer < 4; ++layer)
        any |= bits.words[static_cast<size_t>(4 * half + layer)];
      for (int quarter = 0; quarter < 4; ++quarter) {
        if ((any & (kQuarter << (4 * quarter))) == 0) continue;
        const LatticePoint at = {(4 * brick.bx + quarter) >> shift, brick.by >> shift,
                                 (2 * brick.bz + half) >> shift};
        if (index_.Find(at) != nullptr) continue;
        index_.Set(at, static_cast<uint32_t>(cubes_.size()));
        cubes_.push_back({at, {}, kFar});
      }
    }
  }
}

bool BallGaps::Offer(uint32_t cube, const Ball& ball) {
  const LatticePoint at = cubes_[cube].at;
  const auto middle = [&](int32_t c) { return (c << bits_) + (1 << (bits_ - 1)); };
  const Coordinates place = PlaceOf({middle(at.x), middle(at.y), middle(at.z)}, scale_);
  const Coordinates way = Sum(place, -1, PlaceOf(ball.center, scale_));
  const float gap = static_cast<float>(LengthOf(way) - ball.radius);
  if (gap >= cubes_[cube].gap) return false;
  cubes_[cube].ball = ball;
  cubes_[cube].gap = gap;
  return true;
}

void BallGaps::Spread(StopPoll& poll) {
  std::vector<uint32_t> front, next;
  std::vector<char> waits(cubes_.size());
  for (uint32_t n = 0; n < cubes_.size(); ++n) {
    if (cubes_[n].gap < kFar) front.push_back(n);
  }
  while (!front.empty() && !poll.Stopped(front.size())) {
    for (const uint32_t n : front) waits[n] = 0;
    next.clear();
    for (const uint32_t n : front) {
      const Ball ball = cubes_[n].ball;
      const LatticePoint at = cubes_[n].at;
      for (const LatticePoint step : {LatticePoint{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
        for (const LatticePoint beside : {at + step, at - step}) {
          const uint32_t* m = index_.Find(beside);
          if (m == nullptr || !Offer(*m, ball) || waits[*m] != 0) continue;
          waits[*m] = 1;
          next.push_back(*m);
        }
      }
    }
    std::swap(front, next);
  }
}

template <typename Visit>
bool BallGaps::AnyAround(uint32_t cube, Visit visit) const {
  for (int32_t z = -1; z <= 1; ++z) {
    for (int32_t y = -1; y <= 1; ++y) {
      for (int32_t x = -1; x <= 1; ++x) {
        const uint32_t* other = index_.Find(cubes_[cube].at + LatticePoint{x, y, z});
        if (other != nullptr && visit(*other)) return true;
      }
    }
  }
  return false;
}

bool BallGaps::IsPeak(uint32_t cube) const {
  const auto rank = [&](uint32_t n) { return std::pair(cubes_[n].gap, n); };
  return !AnyAround(
      cube, [&](uint32_t other) { return cubes_[other].gap < kFar && rank(other) > rank(cube); });
}

std::vector<BallGaps::Peak> BallGaps::Peaks(double least_radius, double least_gap,
                                            StopPoll& poll) const {
  std::vector<Peak> peaks;
  std::vector<Ball> balls;
  NearbyBricks bricks(object_);
  for (uint32_t n = 0; n < cubes_.size(); ++n) {
    if (poll.Stopped()) break;
    const double radius = cubes_[n].ball.radius, most = cubes_[n].gap + 0.5 * (1 << bits_);
    if (radius < least_radius || most < least_gap * radius || !IsPeak(n)) continue;
    balls.clear();
    AnyAround(n, [&](uint32_t other) {
      const Ball& ball = cubes_[other].ball;
      const bool is_new = std::ranges::find(balls, ball) == balls.end();
      if (cubes_[other].gap < kFar && is_new) balls.push_back(ball);
      return false;
    });
    const Peak peak = PeakIn(n, balls, bricks);
    const bool is_far = peak.gap > 0 && peak.gap >= least_gap * peak.ball.radius;
    if (is_far && peak.ball.radius >= least_radius) peaks.push_back(peak);
  }
  return peaks;
}

double BallGaps::GapAt(LatticePoint p, const std::vector<Ball>& balls, Ball& nearest) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls) {
    const Coordinates way = Sum(PlaceOf(p, scale_), -1, PlaceOf(ball.center, scale_));
    const double gap = LengthOf(way) - ball.radius;
    if (gap < least) least = gap, nearest = ball;
  }
  return least;
}

// The best of eight points of each of the 27 cubes, and from there uphill. Points with even
// coordinates are on the lattice.
BallGaps::Peak BallGaps::PeakIn(uint32_t cube, const std::vector<Ball>& balls,
                                NearbyBricks& bricks) const {
  Peak peak;
  const auto try_at = [&](LatticePoint p) {
    if (!bricks.Contains(p)) return;
    Ball nearest;
    const double gap = GapAt(p, balls, nearest);
    if (gap > peak.gap) peak = {p, nearest, gap};
  };
  const int32_t edge = 1 << bits_, stride = edge / 2;
  AnyAround(cube, [&](uint32_t other) {
    const LatticePoint at = cubes_[other].at;
    for (int32_t z = 0; z < edge; z += stride) {
      for (int32_t y = 0; y < edge; y += stride) {
        for (int32_t x = 0; x < edge; x += stride) {
          try_at({at.x * edge + x, at.y * edge + y, at.z * edge + z});
        }
      }
    }
    return false;
  });
  for (double before = 0; peak.gap > before;) {
    before = peak.gap;
    const LatticePoint tip = peak.tip;
    for (const LatticePoint offset : kDirections14) try_at(tip + offset);
  }
  return peak;
}

}  // namespace bccskel
