#include "proto/wire/duration.h"

#include <cstdint>

namespace bccskel::wire {
namespace {

using std::chrono::nanoseconds;

constexpr int64_t kNanosPerSecond = 1'000'000'000;

}  // namespace

google::protobuf::Duration DurationMessage(nanoseconds duration) {
  google::protobuf::Duration message;
  message.set_seconds(duration.count() / kNanosPerSecond);
  message.set_nanos(static_cast<int32_t>(duration.count() % kNanosPerSecond));
  return message;
}

nanoseconds NanosecondsOf(const google::protobuf::Duration& message) {
  return nanoseconds(message.seconds() * kNanosPerSecond + message.nanos());
}

}  // namespace bccskel::wire
