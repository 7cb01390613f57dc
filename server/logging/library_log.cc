#include "server/logging/library_log.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>

#include <string>

#include "server/logging/json_log.h"

namespace bccskel::server {
namespace {

// Most of their errors are a caller's doing; none of them ends the server.
LogLevel LevelOf(bool error) { return error ? LogLevel::kWarning : LogLevel::kDebug; }

void WriteGrpc(gpr_log_func_args* said) {
  Log(LevelOf(said->severity == GPR_LOG_SEVERITY_ERROR), "grpc",
      {{"message", std::string(said->message)}});
}

void WriteProtobuf(google::protobuf::LogLevel level, const char*, int, const std::string& message) {
  Log(LevelOf(level >= google::protobuf::LOGLEVEL_ERROR), "protobuf", {{"message", message}});
}

}  // namespace

void LogWhatLibrariesSay() {
  gpr_set_log_function(WriteGrpc);
  google::protobuf::SetLogHandler(WriteProtobuf);
}

}  // namespace bccskel::server
