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
#include "server/identity/callers.h"

namespace bccskel::server {

struct CallFacts;

// A streaming call that is under way.
// Threads: safe.
class OpenStream {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  virtual ~OpenStream() = default;
  // Ends the call with this error, unless it has ended.
  virtual void EndEarly(const absl::Status& why) = 0;
  // Errors: ABORTED when the caller has not sent, or read, what it should within the limits.
  virtual absl::Status CheckCaller(TimePoint, const CallerTimeouts&) { return absl::OkStatus(); }
};

// Looks after all of them: ends those whose token is accepted no longer, and those of callers who
// do not send or do not read. Threads: safe.
class OpenStreams {
 public:
  // Needs: `callers` outlives this.
  OpenStreams(const Callers& callers, const CallerTimeouts& timeouts)
      : callers_(callers), timeouts_(timeouts) {}

  // Until Remove().
  void Add(const std::shared_ptr<OpenStream>& call, const CallFacts& facts);
  void Remove(const OpenStream& call);

  // Called once a second.
  void LookAfter();

 private:
  struct Entry {
    std::weak_ptr<OpenStream> call;
    std::string authorization, tenant;
    uint64_t tokens = 0;  // Callers::generation() that accepted it
  };
  // Whether its token is accepted, as far as that is not known. Needs: mutex_ held.
  absl::Status CheckToken(Entry& entry, uint64_t generation) const;

  const Callers& callers_;
  const CallerTimeouts timeouts_;
  std::mutex mutex_;
  std::map<const OpenStream*, Entry> calls_;  // guarded by mutex_
};

// A method of the interface.
struct Method {
  const char* name = "";  // "JobService/CreateJob"
  // Questions change nothing and come often: while all is well they are left to the debug log.
  enum class Kind { kWork, kQuestion } kind = Kind::kWork;
};

// What is known about a call besides its messages.
struct CallFacts {
  using Clock = exec::Context::Clock;

  Method method = {};
  Clock::time_point started = Clock::now();
  Clock::time_point deadline = Clock::time_point::max();
  std::string trace;                    // the caller's traceparent, if it is one; for the log
  std::string tenant = kDefaultTenant;  // whose call it is
  Role role = Role::kTenant;
  // Whether the server cuts calls off now; null: it never does. Outlives the call.
  const std::atomic<bool>* cut_off = nullptr;
  std::string authorization = {};  // the header, empty where there was none; never shown to anybody
  uint64_t tokens = 0;             // Callers::generation() that accepted it
  // Who looks after streaming calls; null: nobody does. Outlives the call.
  OpenStreams* lasting = nullptr;
  const grpc::CallbackServerContext* context = nullptr;  // there until gRPC is done with the call

  bool IsCutOff() const { return cut_off != nullptr && *cut_off; }

  // Why gRPC says that the call is over.
  absl::Status CancelStatus() const;
  void LogAccepted(const std::string& job, uint64_t volume_bytes) const;
  // `subject` is the name of the job, upload or volume that the call was about, if there is one.
  void LogEnded(const std::string& subject, const absl::Status& status) const;
};

// The digest that the sender states, if it states one.
std::optional<Sha256Digest> DigestOf(const v1::VolumeFinish& finish);

// A call to something that outlives the process.
struct DurableCall {
  CallFacts facts;
  DurableJobs& durable_jobs;

  const std::string& tenant() const { return facts.tenant; }
};

// Where every call of every service comes in: whose is it? A handler learns the tenant here and
// nowhere else. Calls that are refused are logged here.
// Threads: safe.
class CallGate {
 public:
  // Needs: both outlive the gate. `durable_jobs` is null where nothing is durable.
  explicit CallGate(const Callers& callers, const CallerTimeouts& timeouts = {},
                    DurableJobs* durable_jobs = nullptr)
      : callers_(callers), durable_jobs_(durable_jobs), lasting_(callers, timeouts) {}

  // Errors: UNAUTHENTICATED for a missing or wrong token.
  absl::StatusOr<CallFacts> Enter(const grpc::CallbackServerContext& context,
                                  const Method& method) const;
  // Errors besides: PERMISSION_DENIED for who is no admin.
  absl::StatusOr<CallFacts> EnterAsAdmin(const grpc::CallbackServerContext& context,
                                         const Method& method) const;
  // For calls about what is durable, be it something that has a name, as `field` of the request
  // says. Errors besides: FAILED_PRECONDITION where nothing is; INVALID_ARGUMENT for what can be
  // nobody's name.
  struct Name {
    const char* field;
    const std::string& name;
  };
  absl::StatusOr<DurableCall> EnterDurable(const grpc::CallbackServerContext& context,
                                           const Method& method,
                                           const std::optional<Name>& name = std::nullopt) const;

  DurableJobs* durable_jobs() const { return durable_jobs_; }  // null where nothing is durable

  // From now on calls that gRPC cancels are the server's doing.
  void CutOff() { cut_off_ = true; }
  // Called once a second.
  void LookAfterCalls() { lasting_.LookAfter(); }

 private:
  const Callers& callers_;
  DurableJobs* const durable_jobs_;
  mutable OpenStreams lasting_;
  std::atomic<bool> cut_off_ = false;
};

// The error of a call that goes no further, which is logged.
absl::Status Refused(const CallFacts& facts, const absl::Status& status);

// Ends a unary call: with OK, or with the error and its details.
grpc::ServerUnaryReactor* EndUnary(grpc::CallbackServerContext& context,
                                   const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_CALL_GATE_H_
