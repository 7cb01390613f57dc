#include "server/admission/admission.h"

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "server/admission/refusal.h"

namespace bccskel::server {

Ticket& Ticket::operator=(Ticket&& other) noexcept {
  if (this == &other) return *this;
  Release();
  admission_ = std::exchange(other.admission_, nullptr);
  bytes_ = std::exchange(other.bytes_, 0);
  places_ = std::exchange(other.places_, 0);
  return *this;
}

void Ticket::ShrinkTo(uint64_t bytes) {
  if (bytes >= bytes_) return;
  admission_->GiveBack({.bytes = bytes_ - bytes, .places = 0});
  bytes_ = bytes;
}

absl::Status Ticket::ResizeTo(uint64_t bytes) {
  if (bytes > bytes_) {
    BCCSKEL_RETURN_IF_ERROR(admission_->Grow(*this, bytes));
    bytes_ = bytes;
  }
  ShrinkTo(bytes);
  return absl::OkStatus();
}

void Ticket::LeavePlace() {
  if (places_ > 0) admission_->GiveBack({.bytes = 0, .places = places_});
  places_ = 0;
}

void Ticket::Release() {
  LeavePlace();
  ShrinkTo(0);
}

absl::StatusOr<Ticket> Admission::Admit(uint64_t bytes) {
  std::lock_guard lock(mutex_);
  if (!admitting_) {
    return Refuse(Refusal::kDraining, "the server is shutting down and takes no new jobs");
  }
  BCCSKEL_RETURN_IF_ERROR(CheckLimit(bytes));
  if (usage_.places >= limits_.places) {
    return Refuse(Refusal::kQueueFull,
                  absl::StrFormat("%d jobs at work or waiting, the limit is %d", usage_.places,
                                  limits_.places));
  }
  BCCSKEL_RETURN_IF_ERROR(Take(bytes));
  ++usage_.places;
  return Ticket(this, bytes);
}

absl::Status Admission::CheckLimit(uint64_t bytes) const {
  if (bytes <= limits_.bytes) return absl::OkStatus();
  return Refuse(Refusal::kTooMuchMemory,
                absl::StrFormat("the volume needs up to %d bytes of memory, the limit for all jobs "
                                "together is %d; declare max_bricks (max_label_voxels and max_runs "
                                "of labels) if it is sparse",
                                bytes, limits_.bytes));
}

absl::Status Admission::Take(uint64_t bytes) {
  if (bytes > limits_.bytes - usage_.bytes) {
    return Refuse(Refusal::kMemoryBusy,
                  absl::StrFormat("the volume needs up to %d bytes of memory, %d of %d are free "
                                  "now",
                                  bytes, limits_.bytes - usage_.bytes, limits_.bytes));
  }
  usage_.bytes += bytes;
  return absl::OkStatus();
}

absl::Status Admission::Grow(const Ticket& ticket, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  BCCSKEL_RETURN_IF_ERROR(CheckLimit(bytes));
  return Take(bytes - ticket.bytes());
}

void Admission::StopAdmitting() {
  std::lock_guard lock(mutex_);
  admitting_ = false;
}

void Admission::WaitUntilEmpty(std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  empty_.wait_for(lock, timeout, [this] { return usage_ == Usage(); });
}

Admission::Usage Admission::usage() const {
  std::lock_guard lock(mutex_);
  return usage_;
}

void Admission::GiveBack(const Usage& part) {
  std::lock_guard lock(mutex_);
  usage_.bytes -= part.bytes;
  usage_.places -= part.places;
  if (usage_ == Usage()) empty_.notify_all();
}

}  // namespace bccskel::server
