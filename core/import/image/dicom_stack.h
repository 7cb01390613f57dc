#ifndef BCCSKEL_CORE_IMPORT_IMAGE_DICOM_STACK_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_DICOM_STACK_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/image_info.h"
#include "core/import/image/image_limits.h"

namespace bccskel {

// A plane of voxels and where it lies: LPS, mm.
struct DicomFrame {
  std::string name;  // of its file, for messages
  size_t file = 0;   // which one, and the frame in it
  uint32_t index = 0;
  uint32_t segment = 0;       // of a segmentation
  int64_t columns = 0;        // voxels along x
  int64_t rows = 0;           // and y
  WorldPoint position = {};   // of the center of voxel (0, 0)
  WorldPoint along_row = {};  // x: a unit vector
  WorldPoint along_column = {};
  std::array<double, 2> spacing = {1, 1};  // along x and y
  double thickness = 0;                    // or the distance of slices; 0: unknown
};

enum class DicomGaps {
  kRefused,  // each slice has one frame
  kEmpty,    // any number: a segmentation omits empty slices
};

struct DicomStack {
  ImageSize size;
  Placement placement;
  std::vector<std::vector<DicomFrame>> slices;  // by z
};

// Sorts frames along their normal.
// Needs:  at least one frame.
// Errors: INVALID_ARGUMENT for frames of different sizes, spacings or directions, beside the line
//         through the first and the last, at one position, missing or unevenly spaced; messages
//         name their files. Those of SizeOfAxes() and PlacementOfSteps().
absl::StatusOr<DicomStack> StackFrames(std::vector<DicomFrame> frames, DicomGaps gaps,
                                       const ImageLimits& limits);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_DICOM_STACK_H_
