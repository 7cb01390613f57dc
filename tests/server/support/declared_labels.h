#ifndef BCCSKEL_TESTS_SERVER_SUPPORT_DECLARED_LABELS_H_
#define BCCSKEL_TESTS_SERVER_SUPPORT_DECLARED_LABELS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bccskel/v1/skeletonization_service.pb.h"
#include "core/labels/label_collector.h"
#include "core/labels/skeletonize_labels.h"
#include "core/mask/mask_grid.h"

namespace bccskel::test {

// A segmented image, x fastest.
struct LabelImage {
  MaskGrid grid;
  std::vector<uint64_t> labels;
};

// A ring (one loop), a bar that it cuts into three, a hollow box that the bar touches (one cavity),
// a block and a single voxel, with ids up to the largest.
inline constexpr uint64_t kRing = 3, kBar = 7, kHollow = 1'000, kBlob = (uint64_t{1} << 40) + 5,
                          kDot = ~uint64_t{0};
const LabelImage& FiveLabels();
// One slice each: nets of 65 x 65 voxels with 1,024 loops, whose graphs take more than their
// voxels; labels 1 .. count.
LabelImage ManyNets(int32_t count);

// A volume of labels as a caller sends it.
struct DeclaredLabels {
  v1::SkeletonizeLabelsConfig config;
  std::string bytes;
};
// Declares the truth, as 1, 2, 4 or 8 bytes a voxel.
DeclaredLabels Declare(const LabelImage& image, int label_bytes = 8);

v1::SkeletonizeLabelsRequest LabelsChunk(size_t offset, const std::string& data);
v1::SkeletonizeLabelsRequest LabelsFinish(const DeclaredLabels& labels);
// A whole, well-formed conversation: config, chunks, finish.
std::vector<v1::SkeletonizeLabelsRequest> RequestsFor(const DeclaredLabels& labels,
                                                      size_t chunk_bytes = size_t{1} << 18);

// What the core makes of the image on this machine. Throws on an error, which fails the test.
std::vector<LabelSkeleton> SkeletonsOf(const LabelImage& image, const LabelFilter& filter = {},
                                       const LabelsOptions& options = {});

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_SUPPORT_DECLARED_LABELS_H_
