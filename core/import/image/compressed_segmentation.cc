#include <algorithm>
#include <bit>
#include <cstring>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/chunk_codec.h"

namespace bccskel {
namespace {

constexpr size_t kWordBytes = 4;

// The words of a chunk, which all offsets count.
class Words32 {
 public:
  explicit Words32(std::span<const std::byte> bytes) : bytes_(bytes) {}

  uint64_t count() const { return bytes_.size() / kWordBytes; }
  const std::byte* At(uint64_t word) const { return bytes_.data() + word * kWordBytes; }
  // Needs: word < count().
  uint32_t operator[](uint64_t word) const {
    uint32_t value = 0;
    std::memcpy(&value, At(word), kWordBytes);
    return std::endian::native == std::endian::little ? value : __builtin_bswap32(value);
  }

 private:
  std::span<const std::byte> bytes_;
};

absl::Status Outside(const char* what, uint64_t words) {
  return absl::InvalidArgumentError(
      absl::StrFormat("its compressed segmentation names %s outside its %d words", what, words));
}

// Where a block's table and values begin, in words.
struct BlockHeader {
  uint64_t table;
  uint64_t values;
  uint32_t bits;  // of each value
};

absl::StatusOr<BlockHeader> HeaderAt(const Words32& words, uint64_t at) {
  const uint32_t first = words[at];
  const BlockHeader header = {
      .table = first & 0xffffff, .values = words[at + 1], .bits = first >> 24};
  const bool known = header.bits == 0 || (header.bits <= 32 && std::has_single_bit(header.bits));
  if (known) return header;
  return absl::InvalidArgumentError(absl::StrFormat(
      "its compressed segmentation has values of %d bits; there are 0, 1, 2, 4, ... 32",
      header.bits));
}

struct Box {
  std::array<int64_t, 3> low;
  std::array<int64_t, 3> high;  // behind the last
};

class Expander {
 public:
  Expander(Words32 words, const std::array<int64_t, 3>& size, const std::array<int64_t, 3>& block,
           size_t bytes, std::span<std::byte> into)
      : words_(words), size_(size), block_(block), bytes_(bytes), into_(into) {}

  // The block's voxels that lie in the chunk. Offsets count from the beginning of the channel.
  absl::Status ExpandBlock(const BlockHeader& header, const Box& box) {
    const uint64_t last = VoxelOf(
        {box.high[0] - box.low[0] - 1, box.high[1] - box.low[1] - 1, box.high[2] - box.low[2] - 1});
    if (header.values + ((last + 1) * header.bits + 31) / 32 > words_.count()) {
      return Outside("values", words_.count());
    }
    for (int64_t z = box.low[2]; z < box.high[2]; ++z) {
      for (int64_t y = box.low[1]; y < box.high[1]; ++y) {
        BCCSKEL_RETURN_IF_ERROR(ExpandRow(header, box, y, z));
      }
    }
    return absl::OkStatus();
  }

 private:
  // Which one in its block.
  uint64_t VoxelOf(const std::array<int64_t, 3>& p) const {
    return static_cast<uint64_t>((p[2] * block_[1] + p[1]) * block_[0] + p[0]);
  }

  absl::Status ExpandRow(const BlockHeader& header, const Box& box, int64_t y, int64_t z) {
    std::byte* to =
        into_.data() + static_cast<size_t>((z * size_[1] + y) * size_[0] + box.low[0]) * bytes_;
    uint64_t bit = VoxelOf({0, y - box.low[1], z - box.low[2]}) * header.bits;
    for (int64_t x = box.low[0]; x < box.high[0]; ++x, to += bytes_, bit += header.bits) {
      const uint64_t mask = (uint64_t{1} << header.bits) - 1;
      const uint64_t value =
          header.bits == 0 ? 0 : (words_[header.values + bit / 32] >> (bit % 32)) & mask;
      const uint64_t entry = header.table + value * (bytes_ / kWordBytes);
      if (entry + bytes_ / kWordBytes > words_.count()) return Outside("labels", words_.count());
      std::memcpy(to, words_.At(entry), bytes_);
    }
    return absl::OkStatus();
  }

  Words32 words_;
  std::array<int64_t, 3> size_;
  std::array<int64_t, 3> block_;
  size_t bytes_;
  std::span<std::byte> into_;
};

}  // namespace

absl::Status ExpandCompressedSegmentation(std::span<const std::byte> packed,
                                          const std::array<int64_t, 3>& size,
                                          const std::array<int64_t, 3>& block, size_t bytes,
                                          std::span<std::byte> into) {
  const Words32 all(packed);
  if (all.count() == 0 || all[0] != 1) {
    return absl::InvalidArgumentError("not a compressed segmentation of one channel");
  }
  const Words32 words(packed.subspan(kWordBytes));
  Expander expander(words, size, block, bytes, into);
  uint64_t at = 0;
  Box box = {};
  for (box.low[2] = 0; box.low[2] < size[2]; box.low[2] += block[2]) {
    for (box.low[1] = 0; box.low[1] < size[1]; box.low[1] += block[1]) {
      for (box.low[0] = 0; box.low[0] < size[0]; box.low[0] += block[0], at += 2) {
        for (size_t n = 0; n < 3; ++n) box.high[n] = std::min(box.low[n] + block[n], size[n]);
        if (at + 2 > words.count()) return Outside("blocks", words.count());
        BCCSKEL_ASSIGN_OR_RETURN(const BlockHeader header, HeaderAt(words, at));
        BCCSKEL_RETURN_IF_ERROR(expander.ExpandBlock(header, box));
      }
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel
