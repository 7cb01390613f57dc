#include "server/jobs/volume_intake.h"

#include <algorithm>
#include <span>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

std::span<const std::byte> BytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

bool CarriesHeader(VolumeEncoding encoding) {
  return encoding == VolumeEncoding::kOpenExr || encoding == VolumeEncoding::kBricks;
}

absl::Status CheckExtent(const LatticeExtent& found, const LatticeExtent& declared) {
  if (found == declared) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("the volume's extent is %d x %d x %d cells, declared were %d x %d x %d",
                      found.nx, found.ny, found.nz, declared.nx, declared.ny, declared.nz));
}

}  // namespace

VolumeIntake::VolumeIntake(const VolumeHeader& declared, uint64_t size_bytes,
                           const VolumeLimits& limits, MakeDecoder make_decoder)
    : declared_(declared),
      size_bytes_(size_bytes),
      make_decoder_(std::move(make_decoder)),
      limits_(limits) {
  limits_.max_bricks = std::min(limits.max_bricks, declared.max_bricks);
}

absl::Status VolumeIntake::Append(std::string_view bytes) {
  digest_.Add(bytes);
  return AsCallersError(Decode(bytes));
}

absl::StatusOr<Volume> VolumeIntake::Finish(const std::optional<Sha256Digest>& expected,
                                            const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(digest_.Check(expected));
  if (decoder_ == nullptr) BCCSKEL_RETURN_IF_ERROR(AsCallersError(StartDecoder(front_)));
  absl::StatusOr<Volume> volume = decoder_->Finish(context);
  if (!volume.ok()) return AsCallersError(volume.status());
  return volume;
}

absl::Status VolumeIntake::Decode(std::string_view bytes) {
  if (decoder_ != nullptr) return decoder_->Append(BytesOf(bytes));
  front_.append(bytes);
  const bool header_complete = !CarriesHeader(declared_.encoding) ||
                               front_.size() >= std::min<uint64_t>(kMaxHeaderBytes, size_bytes_);
  return header_complete ? StartDecoder(front_) : absl::OkStatus();
}

absl::Status VolumeIntake::StartDecoder(std::string_view front) {
  VolumeHeader header = declared_;
  if (CarriesHeader(declared_.encoding)) {
    BCCSKEL_ASSIGN_OR_RETURN(header, ScanVolumeHeader(declared_.encoding, BytesOf(front), limits_));
    BCCSKEL_RETURN_IF_ERROR(CheckExtent(header.extent, declared_.extent));
  }
  BCCSKEL_ASSIGN_OR_RETURN(decoder_, make_decoder_(header, limits_));
  BCCSKEL_RETURN_IF_ERROR(decoder_->Append(BytesOf(front)));
  front_ = std::string();
  return absl::OkStatus();
}

// A limit that the caller set for itself is not the server's: breaking it is a wrong argument.
absl::Status VolumeIntake::AsCallersError(absl::Status status) const {
  if (!declared_.declared_bricks.has_value() || !absl::IsResourceExhausted(status)) return status;
  return absl::InvalidArgumentError(status.message());
}

}  // namespace bccskel::server
