#ifndef BCCSKEL_SERVER_CALLS_UNARY_ANSWER_H_
#define BCCSKEL_SERVER_CALLS_UNARY_ANSWER_H_

#include <grpcpp/grpcpp.h>

#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/calls/call_gate.h"
#include "server/calls/status_mapping.h"

namespace bccskel::server {

using Context = grpc::CallbackServerContext;  // as gRPC hands it to a method

// How a unary call that was let in ends: a status for the caller, a line for the log.
class UnaryEnd {
 public:
  // `subject` as in CallFacts::LogEnded(). Needs: made once in a call.
  UnaryEnd(grpc::CallbackServerContext& context, CallFacts facts, std::string subject)
      : reactor_(context.DefaultReactor()),
        facts_(std::move(facts)),
        subject_(std::move(subject)) {}

  void set_subject(const std::string& subject) { subject_ = subject; }
  grpc::ServerUnaryReactor* reactor() const { return reactor_; }

  // Needs: called once.
  grpc::ServerUnaryReactor* operator()(const absl::Status& status) const {
    facts_.LogEnded(subject_, status);  // first: who has the answer may look at the log
    reactor_->Finish(ToGrpcStatus(status));
    return reactor_;
  }

 private:
  grpc::ServerUnaryReactor* reactor_;
  CallFacts facts_;
  std::string subject_;
};

// What DurableJobs calls when a unary call can be answered: `fill` puts the value into the
// response.
template <typename Fill>
auto Answer(const UnaryEnd& end, Fill fill) {
  return [end, fill = std::move(fill)](auto value) {
    if (value.ok()) fill(*value);
    end(StorageError(value.status()));
  };
}

// The same for calls whose response says nothing.
inline auto AnswerNothing(const UnaryEnd& end) {
  return [end](const absl::Status& status) { end(StorageError(status)); };
}

// A unary call that was let in, or why it was not. `serve` takes the call and its end, which it
// calls, or has called, once.
template <typename Serve>
grpc::ServerUnaryReactor* ServeUnary(grpc::CallbackServerContext& context,
                                     const absl::StatusOr<DurableCall>& call,
                                     const std::string& subject, Serve serve) {
  if (!call.ok()) return EndUnary(context, call.status());
  const UnaryEnd end(context, call->facts, subject);
  serve(*call, end);
  return end.reactor();
}

// The same for what `ask`, a function of DurableJobs, does with the named thing. `answer` makes of
// the call's end what DurableJobs calls.
template <typename Ask, typename Answer>
grpc::ServerUnaryReactor* AskDurable(const CallGate& gate, grpc::CallbackServerContext& context,
                                     const Method& method, const CallGate::Name& name, Ask ask,
                                     Answer answer) {
  return ServeUnary(context, gate.EnterDurable(context, method, name), name.name,
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      (call.durable_jobs.*ask)(call.tenant(), name.name, answer(end));
                    });
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_UNARY_ANSWER_H_
