#include "core/certificate/background_gaps.h"

#include <algorithm>
#include <utility>

namespace bccskel {
namespace {

uint64_t PlaceOf(BrickCoordinates brick) { return BrickKey(brick).value() >> 1; }
uint64_t RowOf(uint64_t place) { return place >> 21; }  // BrickKey gives bx 21 bits

BrickCoordinates BrickAtPlace(uint64_t place, Sublattice sublattice) {
  const auto field = [place](int shift) {
    return static_cast<int32_t>((place >> shift) & ((1 << 21) - 1)) - 1;
  };
  return {field(0), field(21), field(42), sublattice};
}

// std::lower_bound that searches near `start` first.
size_t LowerBoundFrom(const std::vector<uint64_t>& places, size_t start, uint64_t wanted) {
  if (start > places.size() || (start > 0 && places[start - 1] >= wanted)) start = 0;
  size_t step = 1;
  while (start + step < places.size() && places[start + step] < wanted) {
    start += step;
    step *= 2;
  }
  const auto begin = places.begin() + static_cast<ptrdiff_t>(start);
  const auto end = places.begin() + static_cast<ptrdiff_t>(std::min(start + step, places.size()));
  return static_cast<size_t>(std::lower_bound(begin, end, wanted) - places.begin());
}

}  // namespace

BackgroundGaps::BackgroundGaps(std::span<const BrickKey> keys, const KnownLayers& known)
    : known_(known) {
  for (BrickKey key : keys) rows_[key.value() & 1].push_back(key.value() >> 1);
  for (const Places& places : rows_) {
    for (size_t n = 0; n < places.size(); ++n) gap_count_ += IsGapBefore(places, n) ? 1 : 0;
  }
}

bool BackgroundGaps::IsGapBefore(const Places& places, size_t n) const {
  return n > 0 && RowOf(places[n - 1]) == RowOf(places[n]) && places[n - 1] + 1 != places[n];
}

// The node of the missing bricks just before the n-th stored brick, within a row: the outside,
// unless both the n-th brick and the one before lie in that row.
size_t BackgroundGaps::NodeBefore(Sublattice sublattice, size_t n, uint64_t row) const {
  const Places& places = rows_[static_cast<size_t>(sublattice)];
  if (n == 0 || n == places.size()) return kOutside;
  if (RowOf(places[n - 1]) != row || RowOf(places[n]) != row) return kOutside;
  return 1 + n + (sublattice == Sublattice::kOdd ? rows_[0].size() : 0);
}

size_t BackgroundGaps::NodeAt(BrickCoordinates missing, size_t& place) const {
  const Places& places = rows_[static_cast<size_t>(missing.sublattice)];
  const uint64_t wanted = PlaceOf(missing);
  place = LowerBoundFrom(places, place, wanted);
  return NodeBefore(missing.sublattice, place, RowOf(wanted));
}

// The missing bricks of a row from brick `first` to `last_x`.
template <typename Visit>
void BackgroundGaps::ForEachNodeOfRow(BrickCoordinates first, int32_t last_x, size_t& place,
                                      Visit visit) const {
  const Places& places = rows_[static_cast<size_t>(first.sublattice)];
  uint64_t at = PlaceOf(first);
  const uint64_t row = RowOf(at), last = at + static_cast<uint64_t>(last_x - first.bx);
  place = LowerBoundFrom(places, place, at);
  for (size_t n = place; at <= last;) {
    if (n < places.size() && places[n] == at) {
      ++n;
      ++at;
      continue;
    }
    visit(NodeBefore(first.sublattice, n, row));
    if (n == places.size()) break;
    at = places[n];
  }
}

std::optional<BackgroundGaps::Gap> BackgroundGaps::GapBefore(size_t place) const {
  const bool odd = place >= rows_[0].size();
  const Sublattice sublattice = odd ? Sublattice::kOdd : Sublattice::kEven;
  const Places& places = rows_[odd ? 1 : 0];
  const size_t n = odd ? place - rows_[0].size() : place;
  if (!IsGapBefore(places, n)) return std::nullopt;
  return Gap{BrickAtPlace(places[n - 1] + 1, sublattice),
             BrickAtPlace(places[n], sublattice).bx - 1,
             NodeBefore(sublattice, n, RowOf(places[n]))};
}

int64_t BackgroundGaps::LinkGap(size_t place, size_t first_member, GapPlaces& hints,
                                UnionFind<size_t>& sets) const {
  const std::optional<Gap> gap = GapBefore(place);
  if (!gap.has_value()) return 0;
  const BrickCoordinates brick = gap->first;
  const int32_t last_x = gap->last_x;
  const Sublattice sublattice = brick.sublattice;
  const bool odd = sublattice == Sublattice::kOdd;
  int64_t joined = 0;
  int row = 0;
  const auto link = [&](BrickCoordinates first, int32_t last) {
    if (!known_.Has(first.bz)) return;
    ForEachNodeOfRow(first, last, hints.of(brick, row), [&](size_t other) {
      joined += sets.Unite(first_member + gap->node, first_member + other) ? 1 : 0;
    });
    ++row;
  };
  for (const auto& [dy, dz] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    link({brick.bx, brick.by + dy, brick.bz + dz, sublattice}, last_x);
  }
  // An even brick touches the odd bricks at its own coordinates and one step back, an odd brick the
  // even ones at its own coordinates and one step ahead.
  const int32_t step = odd ? 1 : -1;
  const Sublattice other = odd ? Sublattice::kEven : Sublattice::kOdd;
  for (const auto& [dy, dz] : {std::pair{0, 0}, {step, 0}, {0, step}, {step, step}}) {
    link({std::min(brick.bx, brick.bx + step), brick.by + dy, brick.bz + dz, other},
         std::max(last_x, last_x + step));
  }
  return joined;
}

}  // namespace bccskel
