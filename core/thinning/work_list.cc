#include "core/thinning/work_list.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/work_list.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

constexpr DirtyMask kSomeToDo = kDirectionsDirty | kEndPointsDirty | kAwake;

// Bit n of each belongs to lane n of a group.
struct GroupBits {
  uint32_t found = 0;
  uint32_t end_points = 0;
  uint32_t odd = 0;
  bool rest = true;  // nothing to do in any pass
};

// Reads a group and settles it.
HWY_INLINE GroupBits TakeGroup(DirtyMask* group, DirtyMask to_visit) {
  GroupBits bits;
#if HWY_TARGET == HWY_SCALAR
  for (size_t n = 0; n < kDirtyGroup; ++n) {
    bits.found |= ((group[n] & (to_visit | kAwake)) != 0 ? 1u : 0u) << n;
    bits.end_points |= ((group[n] & kEndPointsDirty) != 0 ? 1u : 0u) << n;
    bits.odd |= (group[n] >> 15 & 1u) << n;
    bits.rest = bits.rest && (group[n] & kSomeToDo) == 0;
    group[n] = static_cast<DirtyMask>(group[n] & ~(to_visit | kEndPointsDirty));
  }
#else
  const hn::CappedTag<DirtyMask, kDirtyGroup> tag;
  const auto any = hn::Set(tag, static_cast<DirtyMask>(to_visit | kAwake));
  const auto ends = hn::Set(tag, kEndPointsDirty), odd = hn::Set(tag, kOddBrick);
  const auto some = hn::Set(tag, kSomeToDo);
  const auto settled = hn::Set(tag, static_cast<DirtyMask>(to_visit | kEndPointsDirty));
  const auto zero = hn::Zero(tag);
  for (size_t n = 0; n < kDirtyGroup; n += hn::Lanes(tag)) {
    const auto lanes = hn::LoadU(tag, group + n);
    if (hn::AllTrue(tag, hn::Eq(hn::And(lanes, some), zero))) continue;
    bits.rest = false;
    const auto store = [&](auto mask, uint32_t& to) HWY_ATTR {
      hn::StoreMaskBits(tag, mask, reinterpret_cast<uint8_t*>(&to) + n / 8);
    };
    store(hn::Ne(hn::And(lanes, any), zero), bits.found);
    store(hn::TestBit(lanes, ends), bits.end_points);
    store(hn::TestBit(lanes, odd), bits.odd);
    hn::StoreU(hn::AndNot(settled, lanes), tag, group + n);
  }
#endif
  return bits;
}

// One list being written.
struct ListWriter {
  BrickIndex* list;
  size_t count = 0;

  // Appends first + n for every set bit n. With AVX-512 whole registers are written and the next
  // ones overwrite their tails; elsewhere compressing costs more than mispredicted loop ends.
  HWY_INLINE void Append(uint32_t bits, size_t first) {
#if HWY_TARGET <= HWY_AVX3
    const hn::CappedTag<uint32_t, 16> tag;
    for (size_t n = 0; n < kDirtyGroup; n += 16, bits >>= 16) {
      const auto half = static_cast<uint16_t>(bits);
      const auto mask = hn::LoadMaskBits(tag, reinterpret_cast<const uint8_t*>(&half));
      const auto bricks = hn::Iota(tag, static_cast<uint32_t>(first + n));
      hn::StoreU(hn::Compress(bricks, mask), tag, list + count);
      count += static_cast<size_t>(std::popcount(half));
    }
#else
    for (; bits != 0; bits &= bits - 1) {
      list[count++] = static_cast<BrickIndex>(first + static_cast<size_t>(std::countr_zero(bits)));
    }
#endif
  }
};

void TakeDirtyTarget(const DirtyBricks& dirty, size_t first, size_t last, DirtyMask to_visit,
                     BrickLists& lists, BrickLists& end_lists) {
  ListWriter even = {lists.storage()[0]}, odd = {lists.storage()[1]};
  ListWriter even_ends = {end_lists.storage()[0]}, odd_ends = {end_lists.storage()[1]};
  for (size_t at = first; at < last; at += kDirtyGroup) {
    uint8_t& some = dirty.groups[at / kDirtyGroup];
    if (some == 0) continue;
    GroupBits bits = TakeGroup(dirty.bricks + at, to_visit);
    // Listed bricks may become dirty again in this pass, so their group rests only from the next
    // one on.
    if (bits.rest) some = 0;
    bits.end_points &= ~bits.found;
    if ((bits.found | bits.end_points) == 0) continue;
    even.Append(bits.found & ~bits.odd, at);
    odd.Append(bits.found & bits.odd, at);
    if (bits.end_points == 0) continue;
    even_ends.Append(bits.end_points & ~bits.odd, at);
    odd_ends.Append(bits.end_points & bits.odd, at);
  }
  lists.SetCounts(even.count, odd.count);
  end_lists.SetCounts(even_ends.count, odd_ends.count);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(TakeDirtyTarget);

void TakeDirty(const DirtyBricks& dirty, size_t first, size_t last, DirtyMask to_visit,
               BrickLists& found, BrickLists& end_points) {
  HWY_DYNAMIC_DISPATCH(TakeDirtyTarget)
  (dirty, first, last, to_visit, found, end_points);
}

}  // namespace bccskel
#endif  // HWY_ONCE
