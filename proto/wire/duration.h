#ifndef BCCSKEL_PROTO_WIRE_DURATION_H_
#define BCCSKEL_PROTO_WIRE_DURATION_H_

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace bccskel::wire {

inline google::protobuf::Duration DurationMessage(std::chrono::nanoseconds duration) {
  return google::protobuf::util::TimeUtil::NanosecondsToDuration(duration.count());
}
// Longer times than 285 years, which do not fit, become as long as that.
inline std::chrono::nanoseconds NanosecondsOf(const google::protobuf::Duration& message) {
  constexpr int64_t kMostSeconds = 9'000'000'000;
  return std::chrono::seconds(std::clamp(message.seconds(), -kMostSeconds, kMostSeconds)) +
         std::chrono::nanoseconds(message.nanos());
}

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_DURATION_H_
