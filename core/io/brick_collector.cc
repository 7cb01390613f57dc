#include "core/io/brick_collector.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/layer_transpose.h"

namespace bccskel {
namespace {

// The block of 16 columns a row from column 16 * bx on; columns and rows past the extent are empty.
ColumnBlock GatherColumns(PlaneRows<const uint32_t> rows, int32_t nx, int32_t bx) {
  const int32_t first = bx * kBrickX;
  const auto count = static_cast<size_t>(std::min(kBrickX, nx - first));
  ColumnBlock columns = {};
  for (size_t j = 0; j < rows.rows; ++j) {
    std::memcpy(&columns[16 * j], rows.words + j * rows.stride + first, count * sizeof(uint32_t));
  }
  return columns;
}

uint32_t AnyColumn(const ColumnBlock& columns) {
  uint32_t any = 0;
  for (uint32_t column : columns) any |= column;
  return any;
}

// The bits of a channel's words that stand for layers of the extent.
uint32_t UsedBits(const LatticeExtent& extent, int32_t channel) {
  const int32_t layers = extent.nz - 32 * channel;
  return layers >= 32 ? ~uint32_t{0} : (uint32_t{1} << layers) - 1;
}

absl::Status UnusedBitError(PlaneRowsPlace place, int32_t bx, int32_t nz) {
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s sublattice, channel %d: a word of rows %d to %d, columns from %d, has a bit set past the "
      "last of %d layers",
      place.sublattice == Sublattice::kEven ? "even" : "odd", place.channel, 4 * place.by,
      4 * place.by + 3, bx * kBrickX, nz));
}

}  // namespace

absl::Status BrickCollector::AddRows(PlaneRowsPlace place, PlaneRows<const uint32_t> rows) {
  const int32_t nx = header_.extent.nx;
  const uint32_t unused = ~UsedBits(header_.extent, place.channel);
  for (int32_t bx = 0; bx * kBrickX < nx; ++bx) {
    const ColumnBlock columns = GatherColumns(rows, nx, bx);
    const uint32_t any = AnyColumn(columns);
    if (any == 0) continue;
    if ((any & unused) != 0) return UnusedBitError(place, bx, header_.extent.nz);
    BCCSKEL_RETURN_IF_ERROR(AddLayers(place, bx, LayersOfColumns(columns)));
  }
  return absl::OkStatus();
}

absl::Status BrickCollector::AddLayers(PlaneRowsPlace place, int32_t bx,
                                       const std::array<uint64_t, 32>& layers) {
  for (int32_t n = 0; n < 4; ++n) {
    BrickBits bits;
    std::copy_n(layers.begin() + n * kBrickZ, kBrickZ, bits.words.begin());
    if (bits.Empty()) continue;
    const BrickKey key({bx, place.by, 4 * place.channel + n, place.sublattice});
    BCCSKEL_RETURN_IF_ERROR(AddBrick(key, bits));
  }
  return absl::OkStatus();
}

absl::Status BrickCollector::AddBrick(BrickKey key, const BrickBits& bits) {
  if (keys_.size() >= header_.max_bricks) {
    if (header_.declared_bricks) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "the volume has more bricks than the %d declared", *header_.declared_bricks));
    }
    return absl::ResourceExhaustedError(
        absl::StrFormat("the volume has more bricks than the limit of %d", header_.max_bricks));
  }
  keys_.push_back(key);
  bricks_.push_back(bits);
  return absl::OkStatus();
}

absl::StatusOr<Volume> BrickCollector::Build() && {
  return Volume::Create(header_.extent, header_.placement, std::move(keys_), std::move(bricks_));
}

}  // namespace bccskel
