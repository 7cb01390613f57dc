#ifndef BCCSKEL_SERVER_CALLS_CALL_GATE_H_
#define BCCSKEL_SERVER_CALLS_CALL_GATE_H_

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/volume.pb.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "server/calls/sender_clock.h"
#include "server/durable/durable_jobs.h"
#include "server/durable/flow.h"
#include "server/identity/callers.h"

namespace bccskel::server {

class CallGate;
struct CallFacts;

// A streaming call in progress.
// Threads: safe.
class OpenStream {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  virtual ~OpenStream() = default;
  // Ends the call with this error unless it has ended already.
  virtual void EndEarly(const absl::Status& why) = 0;
  // Errors: ABORTED when the caller has exceeded its time to send or to read.
  virtual absl::Status CheckCaller(TimePoint, const CallerTimeouts&) { return absl::OkStatus(); }
};

// The streaming calls in progress. Ends those whose token is no longer accepted and those whose
// callers do not send or read in time.
// Threads: safe.
class OpenStreams {
 public:
  // Needs: `callers` outlives this.
  OpenStreams(const Callers& callers, const CallerTimeouts& timeouts)
      : callers_(callers), timeouts_(timeouts) {}

  // Watches the call until Remove(). Ends it at once after EndAll().
  void Add(const std::shared_ptr<OpenStream>& call, const CallFacts& facts);
  void Remove(const OpenStream& call);

  // Called once a second.
  void EnforceLimits();
  // Ends all calls, also those that begin later.
  void EndAll(const absl::Status& why);

 private:
  struct Entry {
    std::weak_ptr<OpenStream> call;
    std::string authorization, tenant;
    uint64_t tokens = 0;  // Callers::generation() that accepted it
  };
  // Checks the call's token again if the tokens have changed since it was accepted. Needs: mutex_
  // held.
  absl::Status CheckToken(Entry& entry, uint64_t generation) const;

  const Callers& callers_;
  const CallerTimeouts timeouts_;
  std::mutex mutex_;
  std::map<const OpenStream*, Entry> calls_;  // guarded by mutex_
  absl::Status ended_;                        // guarded by mutex_: why all were ended
};

// A method of the interface.
struct Method {
  const char* name = "";  // "JobService/CreateJob"
  // Queries (kQuestion) change nothing and are frequent: unless they fail they are logged at level
  // debug only.
  enum class Kind { kWork, kQuestion } kind = Kind::kWork;
};

// What is known about a call besides its messages.
struct CallFacts {
  using Clock = exec::Context::Clock;

  Method method = {};
  Clock::time_point started = Clock::now();
  Clock::time_point deadline = Clock::time_point::max();
  std::string trace;                    // the caller's traceparent, if valid; for the log
  std::string tenant = kDefaultTenant;  // of the caller
  Role role = Role::kTenant;
  std::string authorization = {};  // the header, empty if absent; never shown to anybody
  uint64_t tokens = 0;             // Callers::generation() that accepted it
  const grpc::CallbackServerContext* context = nullptr;  // valid until gRPC is done with the call
  const CallGate* gate = nullptr;                        // that it has entered; outlives the call

  // The status of a call that gRPC reports as cancelled.
  absl::Status CancelStatus() const;
  void LogAccepted(const std::string& job, uint64_t volume_bytes) const;
  // `subject` is the name of the job, upload or volume of the call, if any.
  void LogEnded(const std::string& subject, const absl::Status& status) const;
};

// The digest that the sender states, if any.
std::optional<Sha256Digest> DigestOf(const v1::VolumeFinish& finish);

// A call about durable data.
struct DurableCall {
  CallFacts facts;
  DurableJobs& durable_jobs;

  const std::string& tenant() const { return facts.tenant; }
};

// The entry of every call of every service: identifies the caller. Handlers learn the tenant here
// and nowhere else. Logs refused calls.
// Threads: safe.
class CallGate {
 public:
  // Needs: `callers` and `durable_jobs` outlive the gate. `durable_jobs` is null without a data
  // directory.
  explicit CallGate(const Callers& callers, const CallerTimeouts& timeouts = {},
                    DurableJobs* durable_jobs = nullptr)
      : callers_(callers), durable_jobs_(durable_jobs), open_streams_(callers, timeouts) {}

  // Errors: UNAUTHENTICATED for a missing or wrong token; UNAVAILABLE after CutOff().
  absl::StatusOr<CallFacts> Enter(const grpc::CallbackServerContext& context,
                                  const Method& method) const;
  // Errors: as Enter(); PERMISSION_DENIED if the caller is not an admin.
  absl::StatusOr<CallFacts> EnterAsAdmin(const grpc::CallbackServerContext& context,
                                         const Method& method) const;
  // For calls about durable data. If the request names something, `name` holds its field and value.
  // Errors: as Enter(); FAILED_PRECONDITION without durable data; INVALID_ARGUMENT for a malformed
  //         name.
  struct Name {
    const char* field;
    const std::string& name;
  };
  absl::StatusOr<DurableCall> EnterDurable(const grpc::CallbackServerContext& context,
                                           const Method& method,
                                           const std::optional<Name>& name = std::nullopt) const;

  DurableJobs* durable_jobs() const { return durable_jobs_; }  // null without a data directory

  // Refuses every further call, and ends the streaming ones, with DRAINING: a call that gRPC itself
  // cancels as it stops tells its caller no reason. From now on cancelled calls count as aborted by
  // the server. Returns when the unary calls are answered, or after `timeout`.
  void CutOff(std::chrono::milliseconds timeout);
  // Whether the server aborts calls.
  bool is_cut_off() const { return cut_off_; }
  // Called once a second.
  void EnforceCallLimits() { open_streams_.EnforceLimits(); }

  OpenStreams& open_streams() const { return open_streams_; }
  // A unary call is unanswered until the last copy of the token is gone.
  Operations::Token BeginAnswer() const { return unanswered_.Begin(); }

 private:
  const Callers& callers_;
  DurableJobs* const durable_jobs_;
  mutable OpenStreams open_streams_;
  mutable Operations unanswered_;
  std::atomic<bool> cut_off_ = false;
};

// Logs the end of a refused call and returns its error.
absl::Status Refused(const CallFacts& facts, const absl::Status& status);

// Ends a unary call with OK or with the error and its details.
grpc::ServerUnaryReactor* EndUnary(grpc::CallbackServerContext& context,
                                   const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_CALL_GATE_H_
