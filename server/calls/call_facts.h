#ifndef BCCSKEL_SERVER_CALLS_CALL_FACTS_H_
#define BCCSKEL_SERVER_CALLS_CALL_FACTS_H_

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "bccskel/v1/volume.pb.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "server/identity/callers.h"

namespace bccskel::server {

class LastingCall;
class LastingCalls;

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
  LastingCalls* lasting = nullptr;

  // Has a streaming call looked after, where there is somebody, until it leaves.
  void LookAfter(const std::shared_ptr<LastingCall>& call) const;
  void Leave(const LastingCall& call) const;

  // Why gRPC says that the call is over.
  absl::Status CancelStatus() const;
  void LogAccepted(const std::string& job, uint64_t volume_bytes) const;
  // `subject` is the name of the job, upload or volume that the call was about, if there is one.
  void LogEnded(const std::string& subject, const absl::Status& status) const;
};
CallFacts FactsOf(const grpc::CallbackServerContext& context);

// The digest that the sender states, if it states one.
std::optional<Sha256Digest> DigestOf(const v1::VolumeFinish& finish);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_CALL_FACTS_H_
