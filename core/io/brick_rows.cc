#include "core/io/brick_rows.h"

#include <algorithm>
#include <cstring>

#include "core/io/layer_transpose.h"

namespace bccskel {
namespace {

// Bits of a rank: 2 for the brick's place in its channel, 18 for bx, 17 for the channel, 20 for by,
// 1 for the sublattice; kMaxExtentCells fits in all of them.
constexpr int kBxShift = 2;
constexpr int kChannelShift = kBxShift + 18;
constexpr int kByShift = kChannelShift + 17;
constexpr int kSublatticeShift = kByShift + 20;
static_assert(kMaxExtentCells / kBrickX <= 1 << 18 && kMaxExtentCells / 32 <= 1 << 17 &&
              kMaxExtentCells / kBrickY <= 1 << 20);

uint64_t FirstRank(PlaneRowsPlace place) {
  return static_cast<uint64_t>(place.sublattice) << kSublatticeShift |
         static_cast<uint64_t>(place.by) << kByShift |
         static_cast<uint64_t>(place.channel) << kChannelShift;
}

uint64_t RankOf(BrickCoordinates brick) {
  return FirstRank({brick.sublattice, brick.by, brick.bz / 4}) |
         static_cast<uint64_t>(brick.bx) << kBxShift | static_cast<uint64_t>(brick.bz % 4);
}

constexpr uint64_t kBlockMask = ~uint64_t{3};  // drops the place in the channel

}  // namespace

BrickRows::BrickRows(const Volume& volume) : volume_(volume) {
  entries_.reserve(volume.brick_count());
  for (size_t n = 0; n < volume.brick_count(); ++n) {
    entries_.push_back({RankOf(volume.keys()[n].coordinates()), static_cast<BrickIndex>(n)});
  }
  std::ranges::sort(entries_, {}, &Entry::rank);
}

void BrickRows::Fill(PlaneRowsPlace place, PlaneRows<uint32_t> rows) const {
  const auto nx = static_cast<size_t>(volume_.extent().nx);
  for (size_t j = 0; j < rows.rows; ++j) std::fill_n(rows.words + j * rows.stride, nx, 0u);
  const uint64_t end_rank = FirstRank(place) + (uint64_t{1} << kChannelShift);
  const auto begin = std::ranges::lower_bound(entries_, FirstRank(place), {}, &Entry::rank);
  const auto end = std::ranges::lower_bound(begin, entries_.end(), end_rank, {}, &Entry::rank);
  for (auto first = begin; first != end;) {
    const uint64_t block = first->rank & kBlockMask;
    const auto last =
        std::find_if(first, end, [&](const Entry& e) { return (e.rank & kBlockMask) != block; });
    FillBlock(&*first, &*first + (last - first), rows);
    first = last;
  }
}

void BrickRows::FillBlock(const Entry* first, const Entry* last, PlaneRows<uint32_t> rows) const {
  LayerBlock layers = {};
  for (const Entry* entry = first; entry != last; ++entry) {
    const auto words = volume_.bricks()[entry->brick].words;
    std::ranges::copy(words, layers.begin() + static_cast<ptrdiff_t>(8 * (entry->rank & 3)));
  }
  const ColumnBlock columns = ColumnsOfLayers(layers);
  const int32_t x = volume_.keys()[first->brick].coordinates().bx * kBrickX;
  const auto count = static_cast<size_t>(std::min(kBrickX, volume_.extent().nx - x));
  for (size_t j = 0; j < rows.rows; ++j) {
    std::memcpy(rows.words + j * rows.stride + x, &columns[16 * j], count * sizeof(uint32_t));
  }
}

}  // namespace bccskel
