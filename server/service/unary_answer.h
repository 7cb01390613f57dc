#ifndef BCCSKEL_SERVER_SERVICE_UNARY_ANSWER_H_
#define BCCSKEL_SERVER_SERVICE_UNARY_ANSWER_H_

#include <grpcpp/grpcpp.h>

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/service/ledger_status.h"
#include "server/status_mapping.h"

namespace bccskel::server {

// What the ledger calls when a unary call can be answered: `fill` puts the value into the response.
template <typename Fill>
auto Answer(grpc::ServerUnaryReactor* reactor, const LedgerReasons& reasons, Fill fill) {
  return [reactor, reasons, fill = std::move(fill)](auto value) {
    if (!value.ok()) {
      return reactor->Finish(ToGrpcStatus(WithLedgerReason(value.status(), reasons)));
    }
    fill(*value);
    reactor->Finish(grpc::Status::OK);
  };
}

// The same for calls whose response says nothing.
inline auto AnswerNothing(grpc::ServerUnaryReactor* reactor, const LedgerReasons& reasons) {
  return [reactor, reasons](const absl::Status& status) {
    reactor->Finish(ToGrpcStatus(WithLedgerReason(status, reasons)));
  };
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_UNARY_ANSWER_H_
