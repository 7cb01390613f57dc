#ifndef BCCSKEL_SERVER_ADMISSION_ADMISSION_H_
#define BCCSKEL_SERVER_ADMISSION_ADMISSION_H_

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "server/admission/tenant_limits.h"

namespace bccskel::server {

class Admission;

// A job's reservation of memory and of a place among the jobs. The destructor releases both. An
// empty ticket holds nothing.
// Threads: one at a time per ticket.
class Ticket {
 public:
  Ticket() = default;
  ~Ticket() { Release(); }
  Ticket(Ticket&& other) noexcept { *this = std::move(other); }
  Ticket& operator=(Ticket&& other) noexcept;

  uint64_t bytes() const { return bytes_; }
  // Releases the memory above `bytes`.
  void ShrinkTo(uint64_t bytes);
  // Shrinks or grows the reservation to `bytes`.
  // Errors: a CallError: kVolumeTooLarge, or kMemoryBusy with NeededBytesOf(); the ticket is then
  //         unchanged.
  absl::Status ResizeTo(uint64_t bytes);
  // Releases the place among the jobs and keeps the memory.
  void LeavePlace();

 private:
  friend class Admission;
  Ticket(Admission* admission, std::string tenant, uint64_t bytes)
      : admission_(admission), tenant_(std::move(tenant)), bytes_(bytes), places_(1) {}
  void Release();

  Admission* admission_ = nullptr;
  std::string tenant_;
  uint64_t bytes_ = 0;
  int places_ = 0;
};

// Admits jobs while the sum of their needs stays within the limits, of all tenants together and of
// each. It decides immediately, from a volume's declaration; nothing ever waits for it. Needs:
// outlives its tickets.
class Admission {
 public:
  // With several named tenants, one without max_jobs may hold half of the places that the others
  // leave, so that none of them takes all.
  struct Limits {
    uint64_t bytes = 0;  // for all jobs together
    int places = 0;      // jobs that are receiving, waiting or running
    TenantTable tenants = {};
  };
  struct Usage {
    uint64_t bytes = 0;
    int places = 0;

    friend bool operator==(const Usage&, const Usage&) = default;
  };

  // The allocator keeps memory that jobs have freed, separately for each thread, so that the next
  // job need not fault in every page. `reclaim` returns it to the system; it is called where a job
  // might otherwise exceed the limit of bytes.
  explicit Admission(
      const Limits& limits, std::function<void()> reclaim = [] {})
      : limits_(limits), reclaim_(std::move(reclaim)) {}

  // Errors: a CallError: kVolumeTooLarge if the job could never be admitted, else kQueueFull,
  //         kMemoryBusy with NeededBytesOf() or kDraining.
  absl::StatusOr<Ticket> Admit(const std::string& tenant, uint64_t bytes);

  // Applies to later jobs; admitted ones keep what they hold.
  void SetTenants(const TenantTable& tenants);
  // Refuses every further job as kDraining.
  void StopAdmitting();

  // Returns when no ticket holds anything, or after `timeout`.
  void WaitUntilEmpty(std::chrono::milliseconds timeout) const;

  Usage usage() const;
  Usage usage(const std::string& tenant) const;
  // Jobs that hold a place or whose results still hold memory.
  int jobs() const;

 private:
  friend class Ticket;
  // Limit and usage of one tenant, or of all together.
  struct Part {
    const char* whose;  // for messages
    Usage limit, usage;
  };
  // Needs of these: mutex_ held.
  std::array<Part, 2> PartsOf(const std::string& tenant) const;
  // `held` bytes of the job are taken already.
  absl::Status Take(const std::string& tenant, const Usage& wanted, uint64_t held = 0);
  absl::Status Grow(const Ticket& ticket, uint64_t bytes);
  enum class Leaving { kNo, kYes };
  void GiveBack(const std::string& tenant, const Usage& part, Leaving leaving = Leaving::kNo);

  mutable std::mutex mutex_;
  mutable std::condition_variable empty_;
  Limits limits_;  // guarded by mutex_
  const std::function<void()> reclaim_;
  Usage usage_;                           // guarded by mutex_
  uint64_t freed_ = 0;                    // guarded by mutex_; bytes, since the last reclaim_()
  std::map<std::string, Usage> tenants_;  // guarded by mutex_; tenants that hold something
  int jobs_ = 0;                          // guarded by mutex_
  bool admitting_ = true;                 // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_ADMISSION_H_
