#ifndef BCCSKEL_SERVER_LOGGING_GRPC_LOG_H_
#define BCCSKEL_SERVER_LOGGING_GRPC_LOG_H_

namespace bccskel::server {

// From here on what gRPC itself has to say, such as a handshake that failed, goes into the log as
// an event "grpc". Called once.
void LogWhatGrpcSays();

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_LOGGING_GRPC_LOG_H_
