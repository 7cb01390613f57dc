#ifndef BCCSKEL_PROTO_WIRE_DURATION_H_
#define BCCSKEL_PROTO_WIRE_DURATION_H_

#include <google/protobuf/duration.pb.h>

#include <chrono>

namespace bccskel::wire {

google::protobuf::Duration DurationMessage(std::chrono::nanoseconds duration);
std::chrono::nanoseconds NanosecondsOf(const google::protobuf::Duration& message);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_DURATION_H_
