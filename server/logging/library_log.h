#ifndef BCCSKEL_SERVER_LOGGING_LIBRARY_LOG_H_
#define BCCSKEL_SERVER_LOGGING_LIBRARY_LOG_H_

namespace bccskel::server {

// From here on what gRPC and protobuf themselves have to say, such as a handshake that failed or a
// text that is not UTF-8, goes into the log as an event "grpc" or "protobuf". Left alone they write
// to standard error, and a call waits until somebody reads that. Called once.
void LogWhatLibrariesSay();

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_LOGGING_LIBRARY_LOG_H_
