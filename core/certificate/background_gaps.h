#ifndef BCCSKEL_CORE_CERTIFICATE_BACKGROUND_GAPS_H_
#define BCCSKEL_CORE_CERTIFICATE_BACKGROUND_GAPS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/exec/union_find.h"
#include "core/volume/brick.h"

namespace bccskel {

// Caches, for each kind of neighbor, where the last lookup was, since lookups of one kind come in
// increasing order. One per thread.
class GapPlaces {
 public:
  size_t& of(BrickCoordinates brick, int position) {
    return places_[static_cast<size_t>(brick.sublattice)][static_cast<size_t>(position)];
  }

 private:
  alignas(64) std::array<std::array<size_t, 14>, 2> places_ = {};
};

// The layers of bricks that are known when an object is spread over several holders. Beyond them, a
// brick that is not stored need not be background.
struct KnownLayers {
  int32_t first = std::numeric_limits<int32_t>::min();
  int32_t last = std::numeric_limits<int32_t>::max();

  constexpr bool Has(int32_t bz) const { return first <= bz && bz <= last; }
};

// The background where no bricks are stored, as few pieces instead of many empty bricks. A row is
// all bricks of one sublattice with the same by and bz. The bricks missing between two stored
// bricks of a row form one piece, a gap. All other missing bricks form the outside: they lie at the
// end of a row or in a row without stored bricks. Cost: proportional to the number of stored
// bricks, however large the box.
class BackgroundGaps {
 public:
  // Needs: `keys` strictly increasing, those of whole known layers.
  explicit BackgroundGaps(std::span<const BrickKey> keys, const KnownLayers& known = {});

  const KnownLayers& known() const { return known_; }

  static constexpr size_t kOutside = 0;

  // Node numbers are below node_limit(); node_count() of them are used.
  size_t node_limit() const { return 1 + place_count(); }
  int64_t node_count() const { return 1 + gap_count_; }

  // The node of a missing brick. `place` caches the position between calls.
  // Needs: no brick is stored there.
  // Cost:  a few steps if `place` is close.
  size_t NodeAt(BrickCoordinates missing, size_t& place) const;

  // The missing bricks of one row from `first` to `last_x`.
  struct Gap {
    BrickCoordinates first;
    int32_t last_x = 0;
    size_t node = 0;

    uint64_t BrickCount() const { return static_cast<uint64_t>(last_x - first.bx) + 1; }
  };
  // The gap before stored brick `place`, if there is one.
  // Needs: place < place_count().
  size_t place_count() const { return rows_[0].size() + rows_[1].size(); }
  std::optional<Gap> GapBefore(size_t place) const;

  // Unites the gap before stored brick `place`, if there is one, with the gaps and the outside that
  // touch it in the eight neighboring rows of known layers. Node g is member first_member + g of
  // the sets. Returns how many sets it joined. Needs: place < place_count().
  int64_t LinkGap(size_t place, size_t first_member, GapPlaces& places,
                  UnionFind<size_t>& sets) const;

 private:
  // Stored bricks of one sublattice as keys without the sublattice bit, increasing.
  using Places = std::vector<uint64_t>;

  bool IsGapBefore(const Places& places, size_t n) const;
  size_t NodeBefore(Sublattice sublattice, size_t n, uint64_t row) const;
  template <typename Visit>
  void ForEachNodeOfRow(BrickCoordinates first, int32_t last_x, size_t& place, Visit visit) const;

  const KnownLayers known_;
  std::array<Places, 2> rows_;
  int64_t gap_count_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BACKGROUND_GAPS_H_
