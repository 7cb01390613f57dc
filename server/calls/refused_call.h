#ifndef BCCSKEL_SERVER_CALLS_REFUSED_CALL_H_
#define BCCSKEL_SERVER_CALLS_REFUSED_CALL_H_

#include "absl/status/status.h"
#include "server/calls/status_mapping.h"

namespace bccskel::server {

// A streaming call that ends before it begins. `Reactor` is one of grpc::Server*Reactor.
template <typename Reactor>
class RefusedCall final : public Reactor {
 public:
  explicit RefusedCall(const absl::Status& why) { this->Finish(ToGrpcStatus(why)); }
  void OnDone() override { delete this; }
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_REFUSED_CALL_H_
