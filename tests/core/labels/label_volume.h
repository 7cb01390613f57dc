#ifndef BCCSKEL_TESTS_CORE_LABELS_LABEL_VOLUME_H_
#define BCCSKEL_TESTS_CORE_LABELS_LABEL_VOLUME_H_

#include <cstdint>
#include <vector>

#include "core/labels/label_collector.h"
#include "tests/support/reference_mask.h"

namespace bccskel::test {

// A dense image of labels, x fastest.
struct LabelVolume {
  MaskGrid grid;
  std::vector<uint64_t> labels;

  uint64_t& At(int32_t x, int32_t y, int32_t z);
  std::vector<uint64_t> Slice(int32_t z) const;
  ReferenceMask MaskOf(uint64_t label) const;
};

LabelVolume EmptyLabels(int32_t nx, int32_t ny, int32_t nz, const Placement& placement = {});
// Seeded balls of the labels 10, 20, ..., 10 * count; later ones cover earlier ones.
LabelVolume BallLabels(uint64_t seed, int32_t nx, int32_t ny, int32_t nz, int count,
                       double largest_radius);

// Fails the test on an error.
LabeledObjects Collected(const LabelVolume& volume, const LabelFilter& filter = {});

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_LABELS_LABEL_VOLUME_H_
