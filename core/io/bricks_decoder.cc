#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/brick_collector.h"
#include "core/io/bricks_header.h"
#include "core/io/encoded_body.h"
#include "core/io/volume_decoders.h"

namespace bccskel {
namespace {

class BricksDecoder final : public VolumeDecoder {
 public:
  BricksDecoder(const VolumeHeader& header, const VolumeLimits& limits, const LayerPart& part)
      : header_(header),
        limits_(limits),
        part_(part),
        body_(header.compression),
        collector_(header) {}

  absl::Status Append(std::span<const std::byte> bytes) override {
    if (front_bytes_ < front_.size()) BCCSKEL_RETURN_IF_ERROR(AppendFront(bytes));
    if (bytes.empty()) return absl::OkStatus();
    return body_.Append(bytes, [this](auto decoded) { return AddRecords(decoded); });
  }

  absl::StatusOr<Volume> Finish(const exec::Context& context) override {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    if (front_bytes_ < front_.size()) {
      return absl::InvalidArgumentError(
          absl::StrFormat("bricks header cut off: %d of %d bytes", front_bytes_, front_.size()));
    }
    BCCSKEL_RETURN_IF_ERROR(body_.Finish());
    if (record_bytes_ != 0 || records_ != *header_.declared_bricks) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%d bricks declared, but the bytes end after %d records and %d bytes",
                          *header_.declared_bricks, records_, record_bytes_));
    }
    return std::move(collector_).Build();
  }

 private:
  // Consumes bytes until `front_` holds the header, then checks it.
  absl::Status AppendFront(std::span<const std::byte>& bytes) {
    const size_t count = std::min(bytes.size(), front_.size() - front_bytes_);
    std::copy_n(bytes.begin(), count, front_.begin() + front_bytes_);
    bytes = bytes.subspan(count);
    front_bytes_ += count;
    if (front_bytes_ < front_.size()) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader found, ScanBricksHeader(front_, limits_));
    if (found == header_) return absl::OkStatus();
    return absl::InvalidArgumentError("the bricks have another header than the one announced");
  }

  absl::Status AddRecords(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      if (record_bytes_ == 0 && bytes.size() >= record_.size()) {
        BCCSKEL_RETURN_IF_ERROR(AddRecord(bytes.first(record_.size())));
        bytes = bytes.subspan(record_.size());
        continue;
      }
      const size_t count = std::min(bytes.size(), record_.size() - record_bytes_);
      std::copy_n(bytes.begin(), count, record_.begin() + record_bytes_);
      bytes = bytes.subspan(count);
      record_bytes_ += count;
      if (record_bytes_ < record_.size()) break;
      record_bytes_ = 0;
      BCCSKEL_RETURN_IF_ERROR(AddRecord(record_));
    }
    return absl::OkStatus();
  }

  absl::Status AddRecord(std::span<const std::byte> record) {
    BCCSKEL_ASSIGN_OR_RETURN(const BrickRecord parsed, ParseBrickRecord(records_, record));
    ++records_;
    if (!part_.Has(parsed.key.coordinates().bz)) return absl::OkStatus();
    return collector_.AddBrick(parsed.key, parsed.bits);
  }

  const VolumeHeader header_;
  const VolumeLimits limits_;
  const LayerPart part_;
  BodyReader body_;
  BrickCollector collector_;
  std::array<std::byte, kBricksHeaderBytes> front_;
  size_t front_bytes_ = 0;
  std::array<std::byte, kBrickRecordBytes> record_;  // a record that came in parts
  size_t record_bytes_ = 0;
  uint64_t records_ = 0;
};

}  // namespace

std::unique_ptr<VolumeDecoder> MakeBricksDecoder(const VolumeHeader& header,
                                                 const VolumeLimits& limits,
                                                 const LayerPart& part) {
  return std::make_unique<BricksDecoder>(header, limits, part);
}

}  // namespace bccskel
