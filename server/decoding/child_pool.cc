#include "server/decoding/child_pool.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {
namespace {

// Each idle child occupies about 5 MB.
constexpr size_t kMostIdle = 4;

class ChildDecoder final : public VolumeDecoder {
 public:
  ChildDecoder(const VolumeHeader& header, const VolumeLimits& limits, const std::string& tenant,
               ChildPool& pool, SharedBytes bytes)
      : header_(header), limits_(limits), tenant_(tenant), pool_(pool), bytes_(std::move(bytes)) {}

  absl::Status Append(std::span<const std::byte> bytes) override {
    if (bytes.size() > header_.max_encoded_bytes - bytes_.size()) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "more than %d bytes for an OpenEXR volume of %d x %d x %d cells",
          header_.max_encoded_bytes, header_.extent.nx, header_.extent.ny, header_.extent.nz));
    }
    return bytes_.Append(bytes);
  }
  absl::StatusOr<Volume> Finish(const exec::Context& context) override {
    BCCSKEL_RETURN_IF_ERROR(bytes_.Seal());
    BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<ChildProcess> child, pool_.Take(tenant_));
    absl::StatusOr<Volume> volume = child->Decode(bytes_, header_, limits_, context);
    if (volume.ok()) pool_.Keep(tenant_, std::move(child));
    child.reset();
    pool_.StartAhead();
    return volume;
  }

 private:
  const VolumeHeader header_;
  const VolumeLimits limits_;
  const std::string tenant_;
  ChildPool& pool_;
  SharedBytes bytes_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeChildDecoder(const VolumeHeader& header,
                                                                const VolumeLimits& limits,
                                                                const std::string& tenant,
                                                                ChildPool& pool) {
  BCCSKEL_ASSIGN_OR_RETURN(SharedBytes bytes, SharedBytes::Create());
  return std::make_unique<ChildDecoder>(header, limits, tenant, pool, std::move(bytes));
}

ChildPool::ChildPool(std::vector<std::string> command) : command_(std::move(command)) {
  StartAhead();
}

absl::StatusOr<std::unique_ptr<ChildProcess>> ChildPool::Take(const std::string& tenant) {
  {
    std::lock_guard lock(mutex_);
    if (auto child = TakeUsed(tenant); child != nullptr) return child;
    if (fresh_ != nullptr && fresh_->Lives()) return std::move(fresh_);
  }
  return ChildProcess::Start(command_);
}

std::unique_ptr<ChildProcess> ChildPool::TakeUsed(const std::string& tenant) {
  std::erase_if(used_, [](const Idle& idle) { return !idle.child->Lives(); });
  const auto found = std::ranges::find(used_, tenant, &Idle::tenant);
  if (found == used_.end()) return nullptr;
  std::unique_ptr<ChildProcess> child = std::move(found->child);
  used_.erase(found);
  return child;
}

void ChildPool::Keep(const std::string& tenant, std::unique_ptr<ChildProcess> child) {
  Idle surplus;  // destroyed without holding the lock
  std::lock_guard lock(mutex_);
  used_.push_back({tenant, std::move(child)});
  if (used_.size() <= kMostIdle) return;
  surplus = std::move(used_.front());
  used_.pop_front();
}

void ChildPool::StartAhead() {
  {
    std::lock_guard lock(mutex_);
    if (fresh_ != nullptr && fresh_->Lives()) return;
  }
  auto child = ChildProcess::Start(command_);
  if (!child.ok()) return;  // the next Take() reports the error
  std::lock_guard lock(mutex_);
  fresh_ = *std::move(child);
}

std::vector<pid_t> ChildPool::idle() const {
  std::lock_guard lock(mutex_);
  std::vector<pid_t> pids;
  for (const Idle& idle : used_) pids.push_back(idle.child->pid());
  if (fresh_ != nullptr) pids.push_back(fresh_->pid());
  return pids;
}

}  // namespace bccskel::server
