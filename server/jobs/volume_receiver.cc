#include "server/jobs/volume_receiver.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <span>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/digest/crc32c.h"
#include "core/exec/status_macros.h"
#include "core/io/little_endian.h"
#include "server/errors/call_error.h"

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

template <typename Number>
void Widen(std::span<const std::byte> bytes, std::vector<uint64_t>& labels) {
  for (size_t n = 0; n < labels.size(); ++n) {
    labels[n] = LoadNumber<Number>(bytes, n * sizeof(Number));
  }
}

void LoadLabels(int label_bytes, std::span<const std::byte> bytes, std::vector<uint64_t>& labels) {
  switch (label_bytes) {
    case 1:
      return Widen<uint8_t>(bytes, labels);
    case 2:
      return Widen<uint16_t>(bytes, labels);
    case 4:
      return Widen<uint32_t>(bytes, labels);
    default:
      return Widen<uint64_t>(bytes, labels);
  }
}

// The limits are promises of the caller: breaking one is an invalid argument.
absl::Status AsCallersError(absl::Status status) {
  return absl::IsResourceExhausted(status) ? absl::InvalidArgumentError(status.message()) : status;
}

absl::Status CheckPromise(const char* name, uint64_t found, uint64_t promised) {
  if (found <= promised) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("%s: the volume has %d, %d were declared", name, found, promised));
}

absl::Status CheckDigest(Sha256& received, const std::optional<Sha256Digest>& expected) {
  const Sha256Digest found = received.Finish();
  if (!expected.has_value() || *expected == found) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("the received bytes have the SHA-256 digest %s, the request states %s",
                      found.Hex(), expected->Hex()));
}

}  // namespace

absl::Status CheckChunk(const std::string& bytes, std::optional<uint32_t> crc32c) {
  if (!crc32c.has_value() || *crc32c == Crc32c(bytes)) return absl::OkStatus();
  return CallError(
      Reason::kChunkChecksum,
      absl::StrFormat("the chunk's CRC-32C is %d, the request states %d", Crc32c(bytes), *crc32c),
      {.field = "chunk.crc32c"});
}

VolumeReceiver::VolumeReceiver(const VolumeHeader& declared, uint64_t size_bytes,
                               const VolumeLimits& limits, MakeDecoder make_decoder)
    : declared_(declared),
      size_bytes_(size_bytes),
      make_decoder_(std::move(make_decoder)),
      limits_(limits) {
  limits_.max_bricks = std::min(limits.max_bricks, declared.max_bricks);
}

absl::Status VolumeReceiver::Append(std::string_view bytes) {
  digest_.Add(bytes);
  return AsCallersError(Decode(bytes));
}

absl::StatusOr<Volume> VolumeReceiver::Finish(const std::optional<Sha256Digest>& expected,
                                              const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckDigest(digest_, expected));
  if (decoder_ == nullptr) BCCSKEL_RETURN_IF_ERROR(AsCallersError(StartDecoder(front_)));
  absl::StatusOr<Volume> volume = decoder_->Finish(context);
  if (!volume.ok()) return AsCallersError(volume.status());
  return volume;
}

absl::Status VolumeReceiver::Decode(std::string_view bytes) {
  if (decoder_ != nullptr) return decoder_->Append(BytesOf(bytes));
  front_.append(bytes);
  const bool header_complete = !CarriesHeader(declared_.encoding) ||
                               front_.size() >= std::min<uint64_t>(kMaxHeaderBytes, size_bytes_);
  return header_complete ? StartDecoder(front_) : absl::OkStatus();
}

absl::Status VolumeReceiver::StartDecoder(std::string_view front) {
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

// Exceeding the number of bricks that the caller declared is an invalid argument, not a limit of
// the server.
absl::Status VolumeReceiver::AsCallersError(absl::Status status) const {
  if (!declared_.declared_bricks.has_value() || !absl::IsResourceExhausted(status)) return status;
  return absl::InvalidArgumentError(status.message());
}

LabelReceiver::LabelReceiver(const LabelsRequest& request)
    : request_(request), header_(request.header) {}

absl::Status LabelReceiver::Start() {
  if (collector_.has_value()) return absl::OkStatus();
  // Small objects are counted before they are skipped.
  BCCSKEL_ASSIGN_OR_RETURN(
      collector_, LabelCollector::Create(header_.grid, {.labels = request_.labels,
                                                        .max_runs = header_.max_runs,
                                                        .max_labels = header_.max_labels}));
  body_.emplace(header_.compression);
  labels_.resize(header_.grid.VoxelsPerSlice());
  slice_.resize(labels_.size() * static_cast<size_t>(header_.label_bytes));
  return absl::OkStatus();
}

absl::Status LabelReceiver::Append(std::string_view bytes, const exec::Context& context) {
  digest_.Add(bytes);
  BCCSKEL_RETURN_IF_ERROR(Start());
  return AsCallersError(body_->Append(std::as_bytes(std::span(bytes)),
                                      [&](auto decoded) { return AddBytes(decoded, context); }));
}

absl::Status LabelReceiver::AddBytes(std::span<const std::byte> bytes,
                                     const exec::Context& context) {
  if (bytes.size() > header_.DecodedBytes() - received_bytes_) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%d x %d x %d labels of %d bytes have %d bytes: more were sent", header_.grid.nx,
        header_.grid.ny, header_.grid.nz, header_.label_bytes, header_.DecodedBytes()));
  }
  received_bytes_ += bytes.size();
  while (!bytes.empty()) {
    const size_t count = std::min(bytes.size(), slice_.size() - filled_bytes_);
    std::memcpy(slice_.data() + filled_bytes_, bytes.data(), count);
    bytes = bytes.subspan(count);
    filled_bytes_ += count;
    if (filled_bytes_ == slice_.size()) BCCSKEL_RETURN_IF_ERROR(AddSlice(context));
  }
  return absl::OkStatus();
}

absl::Status LabelReceiver::AddSlice(const exec::Context& context) {
  filled_bytes_ = 0;
  LoadLabels(header_.label_bytes, slice_, labels_);
  return collector_->AddSlice(labels_, context);
}

absl::StatusOr<CollectedLabels> LabelReceiver::Finish(const std::optional<Sha256Digest>& expected,
                                                      const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  BCCSKEL_RETURN_IF_ERROR(CheckDigest(digest_, expected));
  BCCSKEL_RETURN_IF_ERROR(Start());
  BCCSKEL_RETURN_IF_ERROR(body_->Finish());
  if (received_bytes_ != header_.DecodedBytes()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d x %d x %d labels of %d bytes have %d bytes: only %d were sent",
                        header_.grid.nx, header_.grid.ny, header_.grid.nz, header_.label_bytes,
                        header_.DecodedBytes(), received_bytes_));
  }
  CollectedLabels collected;
  BCCSKEL_ASSIGN_OR_RETURN(collected.objects, std::move(*collector_).Finish());
  BCCSKEL_RETURN_IF_ERROR(CheckPromises(collected.objects));
  std::vector<LabeledObject>& objects = collected.objects.objects;
  const std::set<uint64_t> wanted(request_.labels.begin(), request_.labels.end());
  if (!wanted.empty()) collected.absent = wanted.size() - objects.size();
  collected.skipped = std::erase_if(
      objects, [this](const LabeledObject& o) { return o.voxels < request_.min_voxels; });
  return collected;
}

absl::Status LabelReceiver::CheckPromises(const LabeledObjects& objects) const {
  uint64_t voxels = 0, largest = 0;
  for (const LabeledObject& object : objects.objects) {
    voxels += object.voxels;
    largest = std::max(largest, object.voxels);
  }
  BCCSKEL_RETURN_IF_ERROR(CheckPromise("max_voxels", voxels, header_.max_voxels));
  return CheckPromise("max_label_voxels", largest, header_.max_label_voxels);
}

}  // namespace bccskel::server
