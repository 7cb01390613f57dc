#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/brick_collector.h"
#include "core/io/encoded_body.h"
#include "core/io/plane_rows.h"
#include "core/io/volume_decoders.h"

namespace bccskel {
namespace {

class PlanesDecoder final : public VolumeDecoder {
 public:
  explicit PlanesDecoder(const VolumeHeader& header)
      : header_(header),
        body_(header.compression),
        collector_(header),
        words_(4 * static_cast<size_t>(header.extent.nx)) {}

  absl::Status Append(std::span<const std::byte> bytes) override {
    return body_.Append(bytes, [this](auto decoded) { return AddWords(decoded); });
  }

  absl::StatusOr<Volume> Finish(const exec::Context& context) override {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    BCCSKEL_RETURN_IF_ERROR(body_.Finish());
    if (!Complete()) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "raw planes of %d x %d x %d cells have %d bytes: only %d were sent", header_.extent.nx,
          header_.extent.ny, header_.extent.nz, header_.decoded_bytes, received_bytes_));
    }
    return std::move(collector_).Build();
  }

 private:
  absl::Status AddWords(std::span<const std::byte> bytes) {
    if (bytes.size() > header_.decoded_bytes - received_bytes_) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "raw planes of %d x %d x %d cells have %d bytes: more were sent", header_.extent.nx,
          header_.extent.ny, header_.extent.nz, header_.decoded_bytes));
    }
    while (!bytes.empty()) {
      const size_t count = std::min(bytes.size(), RowsBytes() - filled_bytes_);
      std::memcpy(reinterpret_cast<std::byte*>(words_.data()) + filled_bytes_, bytes.data(), count);
      bytes = bytes.subspan(count);
      filled_bytes_ += count;
      received_bytes_ += count;
      if (filled_bytes_ == RowsBytes()) BCCSKEL_RETURN_IF_ERROR(FlushRows());
    }
    return absl::OkStatus();
  }

  absl::Status FlushRows() {
    BCCSKEL_RETURN_IF_ERROR(
        collector_.AddRows(place_, {words_.data(), static_cast<size_t>(header_.extent.nx),
                                    RowsInBrickRow(header_.extent, place_.by)}));
    filled_bytes_ = 0;
    StepToNextRows();
    return absl::OkStatus();
  }

  // Rows run fastest, then channels, then sublattices.
  void StepToNextRows() {
    if (++place_.by < BrickRowCount(header_.extent)) return;
    place_.by = 0;
    if (++place_.channel < ChannelCount(header_.extent)) return;
    place_.channel = 0;
    place_.sublattice = Sublattice::kOdd;
  }

  // Of the rows at place_.
  size_t RowsBytes() const {
    return RowsInBrickRow(header_.extent, place_.by) * static_cast<size_t>(header_.extent.nx) *
           sizeof(uint32_t);
  }

  bool Complete() const { return received_bytes_ == header_.decoded_bytes; }

  VolumeHeader header_;
  BodyReader body_;
  BrickCollector collector_;
  PlaneRowsPlace place_;
  std::vector<uint32_t> words_;  // the rows at place_, as far as they have arrived
  size_t filled_bytes_ = 0;      // of words_
  uint64_t received_bytes_ = 0;  // of all planes
};

}  // namespace

std::unique_ptr<VolumeDecoder> MakePlanesDecoder(const VolumeHeader& header) {
  return std::make_unique<PlanesDecoder>(header);
}

}  // namespace bccskel
