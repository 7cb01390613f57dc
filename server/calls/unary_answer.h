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

using Context = grpc::CallbackServerContext;  // as gRPC passes it to a method

// Ends an admitted unary call: sends the status to the caller and logs it.
class UnaryEnd {
 public:
  // `subject` as in CallFacts::LogEnded(). Needs: created once per call.
  UnaryEnd(grpc::CallbackServerContext& context, CallFacts facts, std::string subject)
      : reactor_(context.DefaultReactor()),
        facts_(std::move(facts)),
        subject_(std::move(subject)),
        answer_(facts_.gate->BeginAnswer()) {}

  void set_subject(const std::string& subject) { subject_ = subject; }
  grpc::ServerUnaryReactor* reactor() const { return reactor_; }

  // Needs: called once.
  grpc::ServerUnaryReactor* operator()(const absl::Status& status) const {
    facts_.LogEnded(subject_, status);  // first: a caller with the answer may look at the log
    reactor_->Finish(ToGrpcStatus(status));
    return reactor_;
  }

 private:
  grpc::ServerUnaryReactor* reactor_;
  CallFacts facts_;
  std::string subject_;
  Operations::Token answer_;
};

// Makes the callback that answers a unary call, given the call's end. `fill` puts the value into
// the response.
template <typename Fill>
auto Answer(Fill fill) {
  return [fill = std::move(fill)](const UnaryEnd& end) {
    return [end, fill](auto value) {
      if (value.ok()) fill(*value);
      end(StorageError(value.status()));
    };
  };
}

// The same for calls with an empty response.
inline auto AnswerNothing(const UnaryEnd& end) {
  return [end](const absl::Status& status) { end(StorageError(status)); };
}

// Runs a unary call about durable data. `call` is the admitted call, or why it was refused. `read`
// makes the argument of `ask`, a member function of DurableJobs, from the request; `answer` makes
// its callback from the call's end.
template <typename Read, typename Ask, typename Answer>
grpc::ServerUnaryReactor* AskDurable(grpc::CallbackServerContext& context,
                                     const absl::StatusOr<DurableCall>& call,
                                     const std::string& subject, Read read, Ask ask,
                                     Answer answer) {
  if (!call.ok()) return EndUnary(context, call.status());
  const UnaryEnd end(context, call->facts, subject);
  auto request = read(*call);
  if (!request.ok()) return end(request.status());
  (call->durable_jobs.*ask)(call->tenant(), *std::move(request), answer(end));
  return end.reactor();
}
// The same for requests that consist of a name.
template <typename Ask, typename Answer>
grpc::ServerUnaryReactor* AskDurable(const CallGate& gate, grpc::CallbackServerContext& context,
                                     const Method& method, const CallGate::Name& name, Ask ask,
                                     Answer answer) {
  const auto read = [&](const DurableCall&) { return absl::StatusOr<std::string>(name.name); };
  return AskDurable(context, gate.EnterDurable(context, method, name), name.name, read, ask,
                    answer);
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_UNARY_ANSWER_H_
