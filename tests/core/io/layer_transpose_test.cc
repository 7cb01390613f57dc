#include "core/io/layer_transpose.h"

#include <gtest/gtest.h>

#include <random>

namespace bccskel {
namespace {

ColumnBlock RandomColumns(uint64_t seed) {
  std::mt19937_64 random(seed);
  ColumnBlock columns;
  for (uint32_t& column : columns) column = static_cast<uint32_t>(random());
  return columns;
}

TEST(LayerTranspose, MovesEveryBitToItsPlace) {
  for (size_t column = 0; column < 64; ++column) {
    for (size_t layer = 0; layer < 32; ++layer) {
      ColumnBlock columns = {};
      columns[column] = uint32_t{1} << layer;
      LayerBlock expected = {};
      expected[layer] = uint64_t{1} << column;
      ASSERT_EQ(LayersOfColumns(columns), expected) << "column " << column << " layer " << layer;
    }
  }
}

TEST(LayerTranspose, AgreesWithBitByBitOnRandomBlocks) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const ColumnBlock columns = RandomColumns(seed);
    LayerBlock expected = {};
    for (size_t n = 0; n < 64; ++n) {
      for (size_t k = 0; k < 32; ++k) expected[k] |= uint64_t{(columns[n] >> k) & 1} << n;
    }
    ASSERT_EQ(LayersOfColumns(columns), expected) << "seed " << seed;
  }
}

TEST(LayerTranspose, IsUndoneByItsOpposite) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const ColumnBlock columns = RandomColumns(seed);
    ASSERT_EQ(ColumnsOfLayers(LayersOfColumns(columns)), columns) << "seed " << seed;
  }
}

}  // namespace
}  // namespace bccskel
