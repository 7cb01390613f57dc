#include "core/io/planes_decoder.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {

PlanesDecoder::PlanesDecoder(const VolumeHeader& header)
    : header_(header),
      body_(header.compression),
      collector_(header),
      words_(4 * static_cast<size_t>(header.extent.nx)) {}

absl::Status PlanesDecoder::Append(std::span<const std::byte> bytes) {
  return body_.Append(bytes, [this](auto decoded) { return AddWords(decoded); });
}

size_t PlanesDecoder::RowsBytes() const {
  return RowsInBrickRow(header_.extent, place_.by) * static_cast<size_t>(header_.extent.nx) *
         sizeof(uint32_t);
}

absl::Status PlanesDecoder::AddWords(std::span<const std::byte> bytes) {
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

absl::Status PlanesDecoder::FlushRows() {
  BCCSKEL_RETURN_IF_ERROR(
      collector_.AddRows(place_, {words_.data(), static_cast<size_t>(header_.extent.nx),
                                  RowsInBrickRow(header_.extent, place_.by)}));
  filled_bytes_ = 0;
  StepToNextRows();
  return absl::OkStatus();
}

// Rows run fastest, then channels, then sublattices.
void PlanesDecoder::StepToNextRows() {
  if (++place_.by < BrickRowCount(header_.extent)) return;
  place_.by = 0;
  if (++place_.channel < ChannelCount(header_.extent)) return;
  place_.channel = 0;
  place_.sublattice = Sublattice::kOdd;
}

absl::StatusOr<Volume> PlanesDecoder::Finish(const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  BCCSKEL_RETURN_IF_ERROR(body_.Finish());
  if (!Complete()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "raw planes of %d x %d x %d cells have %d bytes: only %d were sent", header_.extent.nx,
        header_.extent.ny, header_.extent.nz, header_.decoded_bytes, received_bytes_));
  }
  return std::move(collector_).Build();
}

}  // namespace bccskel
