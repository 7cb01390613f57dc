#ifndef BCCSKEL_CORE_IMPORT_IMAGE_FOREGROUND_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_FOREGROUND_H_

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// Which voxels of an image are the object. NaN never is, not even of an inverted rule.
class ForegroundRule {
 public:
  static constexpr double kOpen = std::numeric_limits<double>::infinity();

  // Everything but zero.
  static ForegroundRule NonZero();
  // Errors: INVALID_ARGUMENT for no label.
  static absl::StatusOr<ForegroundRule> Labels(std::vector<uint64_t> labels);
  // low <= value <= high; -kOpen and kOpen leave an end open.
  // Errors: INVALID_ARGUMENT for an end that is not a number, and low > high.
  static absl::StatusOr<ForegroundRule> Range(double low, double high);
  // value >= threshold. Errors: as Range().
  static absl::StatusOr<ForegroundRule> From(double threshold);
  // value < threshold: the inside of a level set is below 0. Errors: as Range().
  static absl::StatusOr<ForegroundRule> Below(double threshold);

  // The object becomes background and the other way round.
  ForegroundRule Inverted() const;

  bool inverted() const { return inverted_; }
  // Sorted, without repetition; empty for a range.
  std::span<const uint64_t> labels() const { return labels_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  std::vector<uint64_t> labels_;
  double low_ = 0;
  double high_ = 0;
  bool inverted_ = false;
};

// 64-bit words in a row of a mask.
constexpr size_t WordsPerRow(int32_t nx) { return (static_cast<size_t>(nx) + 63) / 64; }

// Writes the mask of a slice.
// Shapes: words holds ny * WordsPerRow(nx); voxel (x, y) is bit x % 64 of word
//         y * WordsPerRow(nx) + x / 64; bits of no voxel become zero.
void ForegroundSlice(const ImageSlice& slice, const ForegroundRule& rule,
                     std::span<uint64_t> words);

// How many voxels of a slice are NaN.
uint64_t CountNotNumbers(const ImageSlice& slice);

// Writes the labels of a slice, 0 for background; NaN is background.
// Shapes: labels holds nx * ny, x fastest.
// Errors: INVALID_ARGUMENT for a value that is no whole number from 0 on; names it and its place.
absl::Status LabelSlice(const ImageSlice& slice, std::span<uint64_t> labels);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_FOREGROUND_H_
