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

// A job's right to memory and to a place among the jobs. Gives both back when destroyed. An empty
// ticket holds nothing.
// Threads: one at a time per ticket.
class Ticket {
 public:
  Ticket() = default;
  ~Ticket() { Release(); }
  Ticket(Ticket&& other) noexcept { *this = std::move(other); }
  Ticket& operator=(Ticket&& other) noexcept;

  uint64_t bytes() const { return bytes_; }
  // Gives back what is over `bytes`.
  void ShrinkTo(uint64_t bytes);
  // The same, or takes what is missing.
  // Errors: a CallError: kTooMuchMemory or kMemoryBusy; then the ticket stays as it was.
  absl::Status ResizeTo(uint64_t bytes);
  // Gives back the place among the jobs; the memory stays.
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

// Lets jobs in while the sum of what they need stays within the limits, of all tenants together and
// of each. It decides at once, from what a volume's declaration says, and nothing ever waits for
// it. Needs: outlives its tickets.
class Admission {
 public:
  // Where there are several named tenants, one that has no max_jobs may have half of the places
  // that the others leave: so none of them takes all.
  struct Limits {
    uint64_t bytes = 0;  // of all jobs together
    int places = 0;      // jobs that receive, wait or run
    TenantTable tenants = {};
  };
  struct Usage {
    uint64_t bytes = 0;
    int places = 0;

    friend bool operator==(const Usage&, const Usage&) = default;
  };

  // The allocator keeps what jobs have freed, each thread's for itself, so that the next job need
  // not fault in every page. `reclaim` gives it back to the system; it is called where a job might
  // otherwise lead above the limit of bytes.
  explicit Admission(
      const Limits& limits, std::function<void()> reclaim = [] {})
      : limits_(limits), reclaim_(std::move(reclaim)) {}

  // Errors: a CallError: kTooMuchMemory when it could never be let in, else kQueueFull, kMemoryBusy
  //         or kDraining.
  absl::StatusOr<Ticket> Admit(const std::string& tenant, uint64_t bytes);
  absl::StatusOr<Ticket> Admit(uint64_t bytes) { return Admit(std::string(), bytes); }

  // From now on; what was let in stays.
  void SetTenants(const TenantTable& tenants);
  // From now on every job is refused as kDraining.
  void StopAdmitting();

  // Returns when no ticket holds anything, or when the time is over.
  void WaitUntilEmpty(std::chrono::milliseconds timeout) const;

  Usage usage() const;
  Usage usage(const std::string& tenant) const;
  // Those that have a place, or whose results are not let go of.
  int jobs() const;

 private:
  friend class Ticket;
  // What a tenant may have and has.
  struct Part {
    const char* whose;  // for messages
    Usage limit, usage;
  };
  // Needs of these: mutex_ held.
  std::array<Part, 2> PartsOf(const std::string& tenant) const;
  int MostPlaces(const TenantLimits& own, const Usage& usage) const;
  absl::Status Take(const std::string& tenant, const Usage& part);
  absl::Status Grow(const Ticket& ticket, uint64_t bytes);
  enum class Leaving { kNo, kYes };
  void GiveBack(const std::string& tenant, const Usage& part, Leaving leaving = Leaving::kNo);

  mutable std::mutex mutex_;
  mutable std::condition_variable empty_;
  Limits limits_;  // guarded by mutex_
  const std::function<void()> reclaim_;
  Usage usage_;                           // guarded by mutex_
  uint64_t freed_ = 0;                    // guarded by mutex_; bytes, since the last reclaim_()
  std::map<std::string, Usage> tenants_;  // guarded by mutex_; those that have something
  int jobs_ = 0;                          // guarded by mutex_
  bool admitting_ = true;                 // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_ADMISSION_H_
