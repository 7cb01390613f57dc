#include "core/labels/label_collector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "core/labels/convert_label.h"
#include "core/labels/run_lookup.h"
#include "tests/core/labels/label_volume.h"
#include "tests/core/mask/mask_words.h"

namespace bccskel {
namespace {

using test::BallLabels;
using test::Collected;
using test::LabelVolume;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<uint64_t> LabelsOf(const LabeledObjects& objects) {
  std::vector<uint64_t> labels;
  for (const LabeledObject& object : objects.objects) labels.push_back(object.label);
  return labels;
}

TEST(LabelCollector, GathersTheVoxelsCountsAndBoxesOfEveryLabel) {
  const LabelVolume volume = BallLabels(1, 70, 20, 15, 6, 5);
  const LabeledObjects collected = Collected(volume);
  ASSERT_EQ(LabelsOf(collected).size(), 6u);
  for (const LabeledObject& object : collected.objects) {
    LabelVolume drawn = test::EmptyLabels(70, 20, 15);
    uint64_t voxels = 0;
    VoxelBox box = {{70, 20, 15}, {0, 0, 0}};
    for (const VoxelRun& run : object.runs) {
      for (int32_t x = run.begin; x < run.end; ++x, ++voxels) {
        drawn.At(x, run.y, run.z) = object.label;
        const std::array<int32_t, 3> v = {x, run.y, run.z};
        for (size_t a = 0; a < 3; ++a) {
          box.low[a] = std::min(box.low[a], v[a]);
          box.high[a] = std::max(box.high[a], v[a] + 1);
        }
      }
    }
    EXPECT_EQ(drawn.MaskOf(object.label).voxels, volume.MaskOf(object.label).voxels);
    EXPECT_EQ(voxels, object.voxels);
    EXPECT_EQ(box, object.box);
    EXPECT_TRUE(std::ranges::is_sorted(object.runs));
  }
}

TEST(LabelCollector, KeepsLabelsThatNeedAll64Bits) {
  LabelVolume volume = test::EmptyLabels(3, 1, 1);
  volume.labels = {~uint64_t{0}, 1, uint64_t{1} << 32};
  EXPECT_THAT(LabelsOf(Collected(volume)), ElementsAre(1, uint64_t{1} << 32, ~uint64_t{0}));
}

TEST(LabelCollector, LeavesOutWhatWasNotAskedFor) {
  LabelVolume volume = test::EmptyLabels(8, 1, 1);
  volume.labels = {1, 1, 1, 2, 3, 3, 0, 1};
  EXPECT_THAT(LabelsOf(Collected(volume, {.labels = {3, 2, 9, 3}})), ElementsAre(2, 3));
  EXPECT_THAT(LabelsOf(Collected(volume, {.min_voxels = 2})), ElementsAre(1, 3));
  EXPECT_THAT(LabelsOf(Collected(volume, {.labels = {2, 3}, .min_voxels = 2})), ElementsAre(3));
  EXPECT_THAT(LabelsOf(Collected(volume, {.labels = {9}, .min_voxels = 0})), ElementsAre());
}

TEST(LabelCollector, TakesMaskSlicesAsLabelOne) {
  const test::ReferenceMask mask = test::RandomMask(4, 66, 5, 3, 0.5);
  LabelVolume volume = test::EmptyLabels(66, 5, 3);
  for (size_t n = 0; n < mask.voxels.size(); ++n) volume.labels[n] = mask.voxels[n];
  auto collector = LabelCollector::Create(volume.grid, {});
  ASSERT_TRUE(collector.ok());
  for (int32_t z = 0; z < 3; ++z) {
    ASSERT_TRUE(collector->AddMaskSlice(test::SliceWords(mask, z), {}).ok());
  }
  const auto objects = std::move(*collector).Finish();
  ASSERT_TRUE(objects.ok());
  EXPECT_EQ(objects->objects.at(0).runs, Collected(volume).objects.at(0).runs);
}

absl::Status StatusOfSlices(const MaskGrid& grid, const LabelFilter& filter,
                            const std::vector<std::vector<uint64_t>>& slices) {
  auto collector = LabelCollector::Create(grid, filter);
  if (!collector.ok()) return collector.status();
  for (const std::vector<uint64_t>& slice : slices) {
    if (absl::Status status = collector->AddSlice(slice, {}); !status.ok()) return status;
  }
  return std::move(*collector).Finish().status();
}

TEST(LabelCollector, SaysWhatIsWrongWithItsInput) {
  EXPECT_THAT(StatusOfSlices({2, 1, 1, {}}, {.labels = {0}}, {}).message(),
              HasSubstr("background"));
  EXPECT_THAT(StatusOfSlices({2, 1, 1, {}}, {}, {{1, 2, 3}}).message(), HasSubstr("take 2"));
  EXPECT_THAT(StatusOfSlices({2, 1, 2, {}}, {}, {{1, 2}}).message(), HasSubstr("1 of 2 slices"));
  EXPECT_EQ(StatusOfSlices({3, 1, 1, {}}, {.max_runs = 2}, {{1, 2, 1}}).code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(StatusOfSlices({3, 1, 1, {}}, {.max_labels = 1}, {{1, 0, 2}}).code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_TRUE(StatusOfSlices({3, 1, 1, {}}, {.labels = {1, 2}, .max_labels = 1}, {{1, 0, 2}}).ok());
}

TEST(ConvertLabel, GivesTheObjectThatTheLabelAsAMaskGives) {
  const LabelVolume volume = BallLabels(2, 140, 30, 25, 8, 6);
  const LabeledObjects collected = Collected(volume);
  for (const LabeledObject& object : collected.objects) {
    for (MaskAdjacency adjacency : test::kBothAdjacencies) {
      const auto converted = ConvertLabel(collected.grid, object, {.adjacency = adjacency}, {});
      ASSERT_TRUE(converted.ok()) << converted.status();
      const ConvertedMask whole =
          test::Converted(volume.MaskOf(object.label), {.adjacency = adjacency});
      EXPECT_EQ(converted->volume, whole.volume);
      EXPECT_EQ(converted->mask, whole.mask);
      EXPECT_EQ(converted->voxels, object.voxels);
    }
  }
}

TEST(ConvertLabel, KeepsPiecesApartThatLieAboveEachOther) {
  LabelVolume volume = test::EmptyLabels(6, 5, 24);
  // On either side of the borders between layers of bricks, with gaps of one slice and of many.
  for (int32_t z : {3, 5, 11, 20, 21, 23}) volume.At(2, 2, z) = 7;
  const LabeledObjects collected = Collected(volume);
  const auto converted = ConvertLabel(collected.grid, collected.objects.at(0), {}, {});
  ASSERT_TRUE(converted.ok()) << converted.status();
  EXPECT_EQ(converted->mask, (BettiNumbers{5, 0, 0}));
  EXPECT_EQ(converted->volume, test::Converted(volume.MaskOf(7), {}).volume);
}

TEST(ComponentsOfRuns, AreThoseOfTheMask) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const test::ReferenceMask mask =
        test::RandomMask(seed, 30, 9, 8, 0.05 + 0.02 * static_cast<double>(seed));
    LabelVolume volume = test::EmptyLabels(30, 9, 8);
    for (size_t n = 0; n < mask.voxels.size(); ++n) volume.labels[n] = mask.voxels[n];
    const LabeledObjects collected = Collected(volume);
    const LabeledObject& object = collected.objects.at(0);
    for (MaskAdjacency adjacency : test::kBothAdjacencies) {
      const std::vector<RunIndex> components = ComponentsOfRuns(object.runs, adjacency);
      const std::set<RunIndex> different(components.begin(), components.end());
      EXPECT_EQ(static_cast<int64_t>(different.size()),
                test::ReferenceMaskBetti(mask, test::ReachOf(adjacency)).components);
    }
  }
}

}  // namespace
}  // namespace bccskel
