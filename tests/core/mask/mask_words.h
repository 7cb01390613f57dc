#ifndef BCCSKEL_TESTS_CORE_MASK_MASK_WORDS_H_
#define BCCSKEL_TESTS_CORE_MASK_MASK_WORDS_H_

#include <cstdint>
#include <vector>

#include "core/mask/mask_converter.h"
#include "tests/support/reference_mask.h"

namespace bccskel::test {

// The grid of a reference mask, with the given placement of voxel centers.
MaskGrid GridOf(const ReferenceMask& mask, const Placement& placement = {});
// Slice z in the layout of MaskGrid.
std::vector<uint64_t> SliceWords(const ReferenceMask& mask, int32_t z);
// The whole conversion; fails the test on an error.
ConvertedMask Converted(const ReferenceMask& mask, const MaskOptions& options,
                        const Placement& placement = {});

ObjectReach ReachOf(MaskAdjacency adjacency);
inline constexpr MaskAdjacency kBothAdjacencies[] = {MaskAdjacency::k26, MaskAdjacency::k6};

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_MASK_MASK_WORDS_H_
