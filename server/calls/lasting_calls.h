#ifndef BCCSKEL_SERVER_CALLS_LASTING_CALLS_H_
#define BCCSKEL_SERVER_CALLS_LASTING_CALLS_H_

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "absl/status/status.h"
#include "server/identity/callers.h"

namespace bccskel::server {

struct CallFacts;

// A streaming call that is under way.
// Threads: safe.
class LastingCall {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  virtual ~LastingCall() = default;
  // Ends the call with this error, unless it has ended.
  virtual void EndEarly(const absl::Status& why) = 0;
  // Errors: ABORTED when the caller has not sent what it promised within the limit.
  virtual absl::Status CheckSender(TimePoint, std::chrono::milliseconds) {
    return absl::OkStatus();
  }
};

// Looks after all of them: ends those whose token is accepted no longer, and those of callers who
// do not send. Threads: safe.
class LastingCalls {
 public:
  // A `sender_timeout` of 0 is none. Needs: `callers` outlives this.
  LastingCalls(const Callers& callers, std::chrono::milliseconds sender_timeout)
      : callers_(callers), sender_timeout_(sender_timeout) {}

  // Until Remove().
  void Add(const std::shared_ptr<LastingCall>& call, const CallFacts& facts);
  void Remove(const LastingCall& call);

  // Called once a second.
  void LookAfter();

 private:
  struct Entry {
    std::weak_ptr<LastingCall> call;
    std::string authorization, tenant;
    uint64_t tokens = 0;  // Callers::generation() that accepted it
  };
  // Whether its token is accepted, as far as that is not known. Needs: mutex_ held.
  absl::Status CheckToken(Entry& entry, uint64_t generation) const;

  const Callers& callers_;
  const std::chrono::milliseconds sender_timeout_;
  std::mutex mutex_;
  std::map<const LastingCall*, Entry> calls_;  // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_LASTING_CALLS_H_
