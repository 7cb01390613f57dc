#include "client/encoded_labels.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/io/byte_sink.h"
#include "core/io/encoded_body.h"
#include "core/io/little_endian.h"

namespace bccskel::client {
namespace {

absl::Status CheckVolume(const LabelVolume& volume) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskGrid(volume.grid));
  const int bytes = volume.label_bytes;
  if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) {
    return absl::InvalidArgumentError(
        absl::StrCat("labels of ", bytes, " bytes: must be 1, 2, 4 or 8"));
  }
  const size_t slice = volume.grid.VoxelsPerSlice() * static_cast<size_t>(bytes);
  if (volume.voxels.size() % slice == 0 &&
      volume.voxels.size() / slice == static_cast<size_t>(volume.grid.nz)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(volume.voxels.size(),
                                                 " bytes of labels: ", volume.grid.nz,
                                                 " slices of ", slice, " bytes are needed"));
}

// Counts the figures that the declaration promises.
class PromiseCounter {
 public:
  explicit PromiseCounter(const std::vector<uint64_t>& wanted)
      : wanted_(wanted.begin(), wanted.end()) {}

  template <typename Label>
  void AddRow(std::span<const std::byte> row) {
    const size_t count = row.size() / sizeof(Label);
    for (size_t x = 0; x < count;) {
      const size_t begin = x;
      const auto label = LoadNumber<Label>(row, x * sizeof(Label));
      while (x < count && LoadNumber<Label>(row, x * sizeof(Label)) == label) ++x;
      if (label != 0) AddRun(label, x - begin);
    }
  }

  void Promise(EncodedLabels& labels) const {
    labels.runs = runs_;
    labels.labels = voxels_.size();
    for (const auto& [label, voxels] : voxels_) {
      labels.voxels += voxels;
      labels.largest_voxels = std::max(labels.largest_voxels, voxels);
    }
  }

 private:
  void AddRun(uint64_t label, uint64_t voxels) {
    if (!wanted_.empty() && !wanted_.contains(label)) return;
    voxels_[label] += voxels;
    ++runs_;
  }

  const std::set<uint64_t> wanted_;
  std::unordered_map<uint64_t, uint64_t> voxels_;
  uint64_t runs_ = 0;
};

void AddRow(std::span<const std::byte> row, int label_bytes, PromiseCounter& counter) {
  switch (label_bytes) {
    case 1:
      return counter.AddRow<uint8_t>(row);
    case 2:
      return counter.AddRow<uint16_t>(row);
    case 4:
      return counter.AddRow<uint32_t>(row);
    default:
      return counter.AddRow<uint64_t>(row);
  }
}

template <typename Number>
DenseLabels Paint(const LabeledObjects& labels) {
  const MaskGrid& grid = labels.grid;
  const size_t slice = grid.VoxelsPerSlice();
  DenseLabels image = {sizeof(Number)};
  image.voxels.resize(slice * static_cast<size_t>(grid.nz) * sizeof(Number));
  for (const LabeledObject& object : labels.objects) {
    for (const VoxelRun& run : object.runs) {
      const size_t row = static_cast<size_t>(run.z) * slice +
                         static_cast<size_t>(run.y) * static_cast<size_t>(grid.nx);
      for (int32_t x = run.begin; x < run.end; ++x) {
        StoreNumber(static_cast<Number>(object.label), image.voxels,
                    (row + static_cast<size_t>(x)) * sizeof(Number));
      }
    }
  }
  return image;
}

}  // namespace

DenseLabels DenseLabelsOf(const LabeledObjects& labels) {
  const uint64_t largest = labels.objects.empty() ? 0 : labels.objects.back().label;
  if (largest <= 0xFF) return Paint<uint8_t>(labels);
  if (largest <= 0xFFFF) return Paint<uint16_t>(labels);
  return largest <= 0xFFFF'FFFF ? Paint<uint32_t>(labels) : Paint<uint64_t>(labels);
}

absl::StatusOr<EncodedLabels> EncodeForSending(const LabelVolume& volume,
                                               const std::vector<uint64_t>& wanted,
                                               const std::stop_token& stop) {
  BCCSKEL_RETURN_IF_ERROR(CheckVolume(volume));
  StringSink sink;
  SinkCursor cursor(sink);
  BodyWriter body(VolumeCompression::kZstd, cursor);
  PromiseCounter counter(wanted);
  const size_t row_bytes =
      static_cast<size_t>(volume.grid.nx) * static_cast<size_t>(volume.label_bytes);
  for (size_t at = 0; at < volume.voxels.size(); at += row_bytes) {
    if (stop.stop_requested()) return absl::CancelledError("cancelled by the caller");
    const auto row = volume.voxels.subspan(at, row_bytes);
    AddRow(row, volume.label_bytes, counter);
    BCCSKEL_RETURN_IF_ERROR(body.Write(row));
  }
  BCCSKEL_RETURN_IF_ERROR(body.Finish());
  EncodedLabels encoded = {.grid = volume.grid, .label_bytes = volume.label_bytes};
  encoded.bytes = std::move(sink).Take();
  counter.Promise(encoded);
  return encoded;
}

}  // namespace bccskel::client
