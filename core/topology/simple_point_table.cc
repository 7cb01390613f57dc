#include "core/topology/simple_point_table.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// The neighbors of 64 neighborhoods: for each neighbor one bit per neighborhood.
using Neighborhoods = std::array<uint64_t, kNeighborCount>;

// The neighborhoods from 64 * word on: the lowest six neighbors differ.
Neighborhoods NeighborhoodsOf(size_t word) {
  Neighborhoods present = {0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                           0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};
  for (size_t n = 6; n < present.size(); ++n) present[n] = (word >> (n - 6) & 1) != 0 ? ~0ull : 0;
  return present;
}

// Adds the neighborhoods in which the neighbor is set and one adjacent to it is reached.
template <size_t kNeighbor, size_t... kOther>
uint64_t Reach(const Neighborhoods& present, Neighborhoods& reached,
               std::index_sequence<kOther...> /*all*/) {
  constexpr unsigned kBeside = kSharedNeighbors[kNeighbor];
  const uint64_t beside = (((kBeside >> kOther & 1) != 0 ? reached[kOther] : 0) | ...);
  const uint64_t fresh = beside & present[kNeighbor] & ~reached[kNeighbor];
  reached[kNeighbor] |= fresh;
  return fresh;
}

// The neighborhoods that form one component: all their neighbors are reached from the first.
template <size_t... kAll>
uint64_t AreConnected(const Neighborhoods& present, std::index_sequence<kAll...> all) {
  Neighborhoods reached;
  uint64_t none = ~uint64_t{0};
  ((reached[kAll] = present[kAll] & none, none &= ~present[kAll]), ...);
  while ((Reach<kAll>(present, reached, all) | ...) != 0) {
  }
  return ~none & ~((present[kAll] ^ reached[kAll]) | ...);
}

}  // namespace

const SimplePointTable& SimplePointTable::Get() {
  static const SimplePointTable table;
  return table;
}

SimplePointTable::SimplePointTable() {
  for (size_t n = 0; n < words_.size(); ++n) {
    const Neighborhoods object = NeighborhoodsOf(n);
    Neighborhoods background;
    std::ranges::transform(object, background.begin(), std::bit_not<>());
    constexpr std::make_index_sequence<kNeighborCount> kAll;
    words_[n] = AreConnected(object, kAll) & AreConnected(background, kAll);
  }
}

}  // namespace bccskel
