#ifndef BCCSKEL_SERVER_SERVICE_CALL_FACTS_H_
#define BCCSKEL_SERVER_SERVICE_CALL_FACTS_H_

#include <grpcpp/grpcpp.h>

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "bccskel/v1/volume.pb.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "server/identity/callers.h"

namespace bccskel::server {

// What is known about a call besides its messages.
struct CallFacts {
  using Clock = exec::Context::Clock;

  Clock::time_point started = Clock::now();
  Clock::time_point deadline = Clock::time_point::max();
  std::string trace;                    // the caller's traceparent, if it is one; for the log
  std::string tenant = kDefaultTenant;  // whose call it is
  Role role = Role::kTenant;

  // Why gRPC says that the call is over.
  absl::Status CancelStatus() const;
  void LogAccepted(const std::string& job, uint64_t volume_bytes) const;
  void LogEnded(const std::string& job, const absl::Status& status) const;
};
CallFacts FactsOf(const grpc::CallbackServerContext& context);

// The digest that the sender states, if it states one.
std::optional<Sha256Digest> DigestOf(const v1::VolumeFinish& finish);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_CALL_FACTS_H_
