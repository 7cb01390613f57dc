#include "server/jobs/label_intake.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/little_endian.h"

namespace bccskel::server {
namespace {

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

// The limits are promises of the caller: breaking one is a wrong argument.
absl::Status AsCallersError(absl::Status status) {
  return absl::IsResourceExhausted(status) ? absl::InvalidArgumentError(status.message()) : status;
}

absl::Status CheckPromise(const char* name, uint64_t found, uint64_t promised) {
  if (found <= promised) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("%s: the volume has %d, %d were declared", name, found, promised));
}

}  // namespace

LabelIntake::LabelIntake(const LabelsRequest& request)
    : request_(request), header_(request.header) {}

absl::Status LabelIntake::Start() {
  if (collector_.has_value()) return absl::OkStatus();
  // Small objects are counted before they are left out.
  BCCSKEL_ASSIGN_OR_RETURN(
      collector_, LabelCollector::Create(header_.grid, {.labels = request_.labels,
                                                        .max_runs = header_.max_runs,
                                                        .max_labels = header_.max_labels}));
  body_.emplace(header_.compression);
  labels_.resize(header_.grid.VoxelsPerSlice());
  slice_.resize(labels_.size() * static_cast<size_t>(header_.label_bytes));
  return absl::OkStatus();
}

absl::Status LabelIntake::Append(std::string_view bytes, const exec::Context& context) {
  digest_.Add(bytes);
  BCCSKEL_RETURN_IF_ERROR(Start());
  return AsCallersError(body_->Append(std::as_bytes(std::span(bytes)),
                                      [&](auto decoded) { return AddBytes(decoded, context); }));
}

absl::Status LabelIntake::AddBytes(std::span<const std::byte> bytes, const exec::Context& context) {
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

absl::Status LabelIntake::AddSlice(const exec::Context& context) {
  filled_bytes_ = 0;
  LoadLabels(header_.label_bytes, slice_, labels_);
  return collector_->AddSlice(labels_, context);
}

absl::StatusOr<CollectedLabels> LabelIntake::Finish(const std::optional<Sha256Digest>& expected,
                                                    const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  BCCSKEL_RETURN_IF_ERROR(digest_.Check(expected));
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

absl::Status LabelIntake::CheckPromises(const LabeledObjects& objects) const {
  uint64_t voxels = 0, largest = 0;
  for (const LabeledObject& object : objects.objects) {
    voxels += object.voxels;
    largest = std::max(largest, object.voxels);
  }
  BCCSKEL_RETURN_IF_ERROR(CheckPromise("max_voxels", voxels, header_.max_voxels));
  return CheckPromise("max_label_voxels", largest, header_.max_label_voxels);
}

}  // namespace bccskel::server
