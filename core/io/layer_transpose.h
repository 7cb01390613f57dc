#ifndef BCCSKEL_CORE_IO_LAYER_TRANSPOSE_H_
#define BCCSKEL_CORE_IO_LAYER_TRANSPOSE_H_

#include <array>
#include <cstdint>

namespace bccskel {

// The wire packs 32 layers along z into the word of one (x, y); a brick packs 16 x 4 cells of one
// layer into a word. A block of 16 x 4 x 32 cells is 64 words of the one kind (word 16 * j + i is
// column (i, j), bit k is layer k) or 32 of the other (word k is layer k, bit 16 * j + i is column
// (i, j)): a 64 x 32 bit matrix and its transpose.
using ColumnBlock = std::array<uint32_t, 64>;
using LayerBlock = std::array<uint64_t, 32>;

// Cost: five stages of 16 word swaps, for any bits.
LayerBlock LayersOfColumns(const ColumnBlock& columns) noexcept;
ColumnBlock ColumnsOfLayers(const LayerBlock& layers) noexcept;

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_LAYER_TRANSPOSE_H_
