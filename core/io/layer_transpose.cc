#include "core/io/layer_transpose.h"

#include <cstddef>

namespace bccskel {
namespace {

// One stage of the recursive transposition: in every 2 x 2 grid of kStep x kStep squares the two
// squares off the diagonal change places. `kMask` has the low kStep of every 2 * kStep bits.
template <size_t kStep, uint64_t kMask>
void SwapSquares(LayerBlock& words) {
  for (size_t base = 0; base < words.size(); base += 2 * kStep) {
    for (size_t n = base; n < base + kStep; ++n) {
      const uint64_t changed = ((words[n] >> kStep) ^ words[n + kStep]) & kMask;
      words[n] ^= changed << kStep;
      words[n + kStep] ^= changed;
    }
  }
}

// Transposes the two 32 x 32 matrices that lie side by side in the low and high halves of the
// words.
void TransposeHalves(LayerBlock& words) {
  SwapSquares<16, 0x0000ffff0000ffff>(words);
  SwapSquares<8, 0x00ff00ff00ff00ff>(words);
  SwapSquares<4, 0x0f0f0f0f0f0f0f0f>(words);
  SwapSquares<2, 0x3333333333333333>(words);
  SwapSquares<1, 0x5555555555555555>(words);
}

}  // namespace

LayerBlock LayersOfColumns(const ColumnBlock& columns) noexcept {
  LayerBlock words;
  for (size_t n = 0; n < 32; ++n) words[n] = columns[n] | uint64_t{columns[n + 32]} << 32;
  TransposeHalves(words);
  return words;
}

ColumnBlock ColumnsOfLayers(const LayerBlock& layers) noexcept {
  LayerBlock words = layers;
  TransposeHalves(words);
  ColumnBlock columns;
  for (size_t n = 0; n < 32; ++n) {
    columns[n] = static_cast<uint32_t>(words[n]);
    columns[n + 32] = static_cast<uint32_t>(words[n] >> 32);
  }
  return columns;
}

}  // namespace bccskel
