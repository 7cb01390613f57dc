#ifndef BCCSKEL_TESTS_SUPPORT_RANDOM_NETWORK_H_
#define BCCSKEL_TESTS_SUPPORT_RANDOM_NETWORK_H_

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/import/shapes/random.h"
#include "core/import/shapes/solids.h"

namespace bccskel::test {

// Tubes of radius 1 between random places, some of which five of them meet in.
struct Network {
  std::vector<shapes::Vector> places;
  std::vector<std::pair<size_t, size_t>> tubes;

  std::vector<shapes::Solid> Solids() const {
    std::vector<shapes::Solid> solids;
    for (const auto& [a, b] : tubes) {
      solids.push_back(shapes::RoundCone{places[a], places[b], 1, 1});
    }
    return solids;
  }
  int DegreeOf(size_t place) const {
    return static_cast<int>(std::ranges::count_if(
        tubes, [&](const auto& tube) { return tube.first == place || tube.second == place; }));
  }
  int Junctions() const {
    int junctions = 0;
    for (size_t n = 0; n < places.size(); ++n) junctions += DegreeOf(n) > 2 ? 1 : 0;
    return junctions;
  }
};

inline double SquaredGap(shapes::Vector a, shapes::Vector b) { return Dot(a - b, a - b); }

// Whether two tubes keep away from each other or, where they meet, part at 50 degrees at least.
inline bool KeepApart(const Network& network, std::pair<size_t, size_t> s,
                      std::pair<size_t, size_t> t) {
  constexpr double kLeastGap = 5, kLargestCosine = 0.64;
  const auto at = [&](size_t n) { return network.places[n]; };
  if (s.second == t.first || s.second == t.second) std::swap(s.first, s.second);
  if (s.first == t.second) std::swap(t.first, t.second);
  if (s.first == t.first) {
    return Dot(shapes::Unit(at(s.second) - at(s.first)), shapes::Unit(at(t.second) - at(t.first))) <
           kLargestCosine;
  }
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const auto on = [&](const std::pair<size_t, size_t>& tube, int n) {
        return at(tube.first) + n * (1.0 / kSteps) * (at(tube.second) - at(tube.first));
      };
      if (SquaredGap(on(s, i), on(t, j)) < kLeastGap * kLeastGap) return false;
    }
  }
  return true;
}

inline Network RandomNetwork(uint64_t seed, size_t places = 26) {
  constexpr double kBox = 40, kLeastGap = 10, kLongest = 22;
  constexpr int kMostTubes = 5;
  shapes::Random random(seed);
  Network network;
  for (int tries = 0; tries < 4000 && network.places.size() < places; ++tries) {
    const shapes::Vector p = {random.Between(0, kBox), random.Between(0, kBox),
                              random.Between(0, kBox)};
    const auto is_near = [&](shapes::Vector q) { return SquaredGap(p, q) < kLeastGap * kLeastGap; };
    if (std::ranges::none_of(network.places, is_near)) network.places.push_back(p);
  }
  std::vector<std::pair<double, std::pair<size_t, size_t>>> shortest_first;
  for (size_t a = 0; a < network.places.size(); ++a) {
    for (size_t b = a + 1; b < network.places.size(); ++b) {
      const double gap = SquaredGap(network.places[a], network.places[b]);
      if (gap < kLongest * kLongest) shortest_first.push_back({gap, {a, b}});
    }
  }
  std::ranges::sort(shortest_first);
  for (const auto& found : shortest_first) {
    const auto& tube = found.second;
    const auto apart = [&](const auto& other) { return KeepApart(network, tube, other); };
    if (network.DegreeOf(tube.first) == kMostTubes || network.DegreeOf(tube.second) == kMostTubes ||
        !std::ranges::all_of(network.tubes, apart)) {
      continue;
    }
    network.tubes.push_back(tube);
  }
  return network;
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_RANDOM_NETWORK_H_
