#ifndef BCCSKEL_CORE_IMPORT_IMAGE_GRAY_LEVELS_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_GRAY_LEVELS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/import/image/image_source.h"

namespace bccskel {

// Notices that an image holds gray levels, a level set or several labels, not one mask. Looks at
// rows spread over the image, about 250,000 voxels of them.
class GrayLevels {
 public:
  explicit GrayLevels(const ImageSize& size);

  // The next slice, from z = 0 on.
  void Add(const ImageSlice& slice);

  // If most neighbors in a row that are both not 0 differ: Otsu's threshold between background and
  // object (1979, doi 10.1109/TSMC.1979.4310076).
  std::optional<double> Threshold() const;

  // Values below and above 0, but none in a hundred is 0: of a mask, all would be object.
  bool HasBothSigns() const;

  // There are nonzero values, and all are equal.
  bool HasOneValue() const;

  // Whole numbers of several values above 0, each mostly beside itself or 0: of labels, not of the
  // soft edges of a mask.
  bool HasSeveralLabels() const;

 private:
  // Neighbors in a row that are not 0, of voxels of one value.
  struct Neighbors {
    int64_t equal = 0;
    int64_t others = 0;
  };

  template <typename T>
  void AddRow(std::span<const T> row);
  template <typename T>
  void AddRuns(std::span<const T> row);

  int64_t step_;  // rows from one that is seen to the next
  int64_t next_row_ = 0;
  std::vector<double> values_;  // without zeros, which most voxels are
  size_t zeros_ = 0;
  size_t pairs_ = 0;  // of neighbors that are not 0
  size_t unequal_ = 0;
  std::unordered_map<uint64_t, Neighbors> labels_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_GRAY_LEVELS_H_
