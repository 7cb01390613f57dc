#include "core/io/bricks_decoder.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/little_endian.h"

namespace bccskel {
namespace {

constexpr int32_t kMaxBrickCoordinate =
    (1 << 21) - 3;  // what the fields of a BrickKey can tell apart

bool FitsBrickKey(const BrickCoordinates& brick) {
  const auto fits = [](int32_t v) { return v >= 0 && v <= kMaxBrickCoordinate; };
  return fits(brick.bx) && fits(brick.by) && fits(brick.bz);
}

}  // namespace

absl::Status BricksDecoder::Append(std::span<const std::byte> bytes) {
  if (front_bytes_ < front_.size()) BCCSKEL_RETURN_IF_ERROR(AppendFront(bytes));
  if (bytes.empty()) return absl::OkStatus();
  return body_.Append(bytes, [this](auto decoded) { return AddRecords(decoded); });
}

absl::Status BricksDecoder::AppendFront(std::span<const std::byte>& bytes) {
  const size_t count = std::min(bytes.size(), front_.size() - front_bytes_);
  std::copy_n(bytes.begin(), count, front_.begin() + front_bytes_);
  bytes = bytes.subspan(count);
  front_bytes_ += count;
  if (front_bytes_ < front_.size()) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader found, ScanBricksHeader(front_, limits_));
  if (found == header_) return absl::OkStatus();
  return absl::InvalidArgumentError("the bricks have another header than the one announced");
}

absl::Status BricksDecoder::AddRecords(std::span<const std::byte> bytes) {
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

absl::StatusOr<BrickRecord> ParseBrickRecord(uint64_t number, std::span<const std::byte> record) {
  const auto sublattice = LoadNumber<uint32_t>(record, 12);
  if (sublattice > 1) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "brick record %d: sublattice %d must be 0 (even) or 1 (odd)", number, sublattice));
  }
  const BrickCoordinates brick = {LoadNumber<int32_t>(record, 0), LoadNumber<int32_t>(record, 4),
                                  LoadNumber<int32_t>(record, 8),
                                  static_cast<Sublattice>(sublattice)};
  if (!FitsBrickKey(brick)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("brick record %d: brick (%d, %d, %d), each coordinate must be 0 to %d",
                        number, brick.bx, brick.by, brick.bz, kMaxBrickCoordinate));
  }
  BrickRecord parsed = {BrickKey(brick), {}};
  std::memcpy(parsed.bits.words.data(), record.data() + 16, sizeof(parsed.bits.words));
  return parsed;
}

absl::Status BricksDecoder::AddRecord(std::span<const std::byte> record) {
  BCCSKEL_ASSIGN_OR_RETURN(const BrickRecord parsed, ParseBrickRecord(records_, record));
  ++records_;
  if (!part_.Has(parsed.key.coordinates().bz)) return absl::OkStatus();
  return collector_.AddBrick(parsed.key, parsed.bits);
}

absl::StatusOr<Volume> BricksDecoder::Finish(const exec::Context& context) {
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

}  // namespace bccskel
