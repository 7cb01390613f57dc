#include "server/logging/grpc_log.h"

#include <grpc/support/log.h>

#include <string>

#include "server/logging/json_log.h"

namespace bccskel::server {
namespace {

// Most of gRPC's errors are a caller's doing; none of them ends the server.
LogLevel LevelOf(gpr_log_severity severity) {
  return severity == GPR_LOG_SEVERITY_ERROR ? LogLevel::kWarning : LogLevel::kDebug;
}

void Write(gpr_log_func_args* said) {
  Log(LevelOf(said->severity), "grpc", {{"message", std::string(said->message)}});
}

}  // namespace

void LogWhatGrpcSays() { gpr_set_log_function(Write); }

}  // namespace bccskel::server
