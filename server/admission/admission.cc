#include "server/admission/admission.h"

#include <algorithm>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr char kWhereDeclared[] =
    "declare max_bricks (max_label_voxels and max_runs of labels) if it is sparse";
// Advice for a job whose volume has been received and counted.
constexpr char kWhereCounted[] =
    "send an object with fewer parts, such as a denoised or coarser one, or raise the server's "
    "max-memory-bytes";

absl::Status CheckFits(const char* whose, uint64_t bytes, uint64_t limit, const char* remedy) {
  if (bytes <= limit) return absl::OkStatus();
  return CallError(Reason::kVolumeTooLarge,
                   absl::StrFormat("the volume needs up to %d bytes of memory, the limit for %s is "
                                   "%d; %s",
                                   bytes, whose, limit, remedy),
                   {.quota = "max_admitted_bytes"});
}

}  // namespace

Ticket& Ticket::operator=(Ticket&& other) noexcept {
  if (this == &other) return *this;
  Release();
  admission_ = std::exchange(other.admission_, nullptr);
  tenant_ = std::exchange(other.tenant_, {});
  bytes_ = std::exchange(other.bytes_, 0);
  places_ = std::exchange(other.places_, 0);
  return *this;
}

void Ticket::ShrinkTo(uint64_t bytes) {
  if (bytes >= bytes_) return;
  admission_->GiveBack(tenant_, {.bytes = bytes_ - bytes, .places = 0});
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
  if (places_ > 0) admission_->GiveBack(tenant_, {.bytes = 0, .places = places_});
  places_ = 0;
}

void Ticket::Release() {
  if (admission_ == nullptr) return;
  std::exchange(admission_, nullptr)
      ->GiveBack(tenant_, {.bytes = std::exchange(bytes_, 0), .places = std::exchange(places_, 0)},
                 Admission::Leaving::kYes);
}

absl::StatusOr<Ticket> Admission::Admit(const std::string& tenant, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  if (!admitting_) {
    return CallError(Reason::kDraining, "the server is shutting down and accepts no new jobs");
  }
  BCCSKEL_RETURN_IF_ERROR(Take(tenant, {.bytes = bytes, .places = 1}));
  ++jobs_;
  return Ticket(this, tenant, bytes);
}

std::array<Admission::Part, 2> Admission::PartsOf(const std::string& tenant) const {
  const TenantLimits& own = limits_.tenants.Of(tenant);
  const auto found = tenants_.find(tenant);
  const Usage usage = found == tenants_.end() ? Usage() : found->second;
  const Usage all = {.bytes = limits_.bytes, .places = limits_.places};
  return {Part{"all jobs together", all, usage_},
          Part{"this tenant's jobs together",
               {.bytes = own.max_bytes > 0 ? std::min(own.max_bytes, all.bytes) : all.bytes,
                .places = limits_.tenants.MostPlaces(tenant, limits_.places,
                                                     usage_.places - usage.places)},
               usage}};
}

absl::Status Admission::Take(const std::string& tenant, const Usage& wanted, uint64_t held) {
  for (const Part& part : PartsOf(tenant)) {
    BCCSKEL_RETURN_IF_ERROR(CheckFits(part.whose, wanted.bytes, part.limit.bytes, kWhereDeclared));
    if (part.usage.places + wanted.places > part.limit.places) {
      const bool is_share = part.limit.places < limits_.places && limits_.tenants.Shares(tenant);
      return CallError(Reason::kQueueFull,
                       absl::StrFormat("%d jobs are running or waiting, the limit for %s is %d%s",
                                       part.usage.places, part.whose, part.limit.places,
                                       is_share ? ", half of what other tenants leave" : ""));
    }
    const uint64_t free_bytes = part.limit.bytes - std::min(part.limit.bytes, part.usage.bytes);
    if (wanted.bytes > free_bytes) {
      const char* const more = held > 0 ? "more " : "";
      return MemoryBusy(
          absl::StrFormat("the volume needs up to %d %sbytes of memory, %d of %d are "
                          "free now for %s",
                          wanted.bytes, more, free_bytes, part.limit.bytes, part.whose),
          held + wanted.bytes);
    }
  }
  if (usage_.bytes + wanted.bytes + freed_ > limits_.bytes) {
    reclaim_();
    freed_ = 0;
  }
  for (Usage* usage : {&usage_, &tenants_[tenant]}) {
    usage->bytes += wanted.bytes;
    usage->places += wanted.places;
  }
  return absl::OkStatus();
}

absl::Status Admission::Grow(const Ticket& ticket, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  for (const Part& part : PartsOf(ticket.tenant_)) {
    BCCSKEL_RETURN_IF_ERROR(CheckFits(part.whose, bytes, part.limit.bytes, kWhereCounted));
  }
  return Take(ticket.tenant_, {.bytes = bytes - ticket.bytes(), .places = 0}, ticket.bytes());
}

void Admission::SetTenants(const TenantTable& tenants) {
  std::lock_guard lock(mutex_);
  limits_.tenants = tenants;
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

Admission::Usage Admission::usage(const std::string& tenant) const {
  std::lock_guard lock(mutex_);
  const auto found = tenants_.find(tenant);
  return found == tenants_.end() ? Usage() : found->second;
}

int Admission::jobs() const {
  std::lock_guard lock(mutex_);
  return jobs_;
}

void Admission::GiveBack(const std::string& tenant, const Usage& part, Leaving leaving) {
  std::lock_guard lock(mutex_);
  if (leaving == Leaving::kYes) --jobs_;
  freed_ += part.bytes;
  Usage& own = tenants_[tenant];
  for (Usage* usage : {&usage_, &own}) {
    usage->bytes -= part.bytes;
    usage->places -= part.places;
  }
  if (own == Usage()) tenants_.erase(tenant);
  if (usage_ == Usage()) empty_.notify_all();
}

}  // namespace bccskel::server
