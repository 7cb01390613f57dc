#ifndef BCCSKEL_PROTO_WIRE_DURATION_H_
#define BCCSKEL_PROTO_WIRE_DURATION_H_

#include <google/protobuf/util/time_util.h>

#include <chrono>

namespace bccskel::wire {

inline google::protobuf::Duration DurationMessage(std::chrono::nanoseconds duration) {
  return google::protobuf::util::TimeUtil::NanosecondsToDuration(duration.count());
}
inline std::chrono::nanoseconds NanosecondsOf(const google::protobuf::Duration& message) {
  return std::chrono::nanoseconds(google::protobuf::util::TimeUtil::DurationToNanoseconds(message));
}

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_DURATION_H_
