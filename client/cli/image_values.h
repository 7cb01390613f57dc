#ifndef BCCSKEL_CLIENT_CLI_IMAGE_VALUES_H_
#define BCCSKEL_CLIENT_CLI_IMAGE_VALUES_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/image_arguments.h"
#include "core/exec/context.h"
#include "core/import/image/image_info.h"

namespace bccskel::cli {

// What the voxels of an image hold.
struct ImageValues {
  struct Range {
    long double low;
    long double high;
  };
  VoxelType type = VoxelType::kUint8;
  std::optional<Range> range;  // none where no value is a number
  uint64_t not_numbers = 0;
  // Voxels of each value but 0. None where a value is no whole number from 0 on, and above
  // kMostLabels values: then these are no labels.
  std::optional<std::map<uint64_t, uint64_t>> labels;
};
inline constexpr size_t kMostLabels = 1 << 16;

// Errors: as OpenImage() and NextSlice(), with the path; CANCELLED.
absl::StatusOr<ImageValues> ReadImageValues(const std::string& path, const ImageOptions& options,
                                            const exec::Context& context);

// "values:      0 to 3\nlabels:      1 (80 voxels), 3 (12 voxels)\n"; and the same as members of a
// JSON object.
std::string ValuesText(const ImageValues& values);
std::string ValuesJson(const ImageValues& values);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_IMAGE_VALUES_H_
