#include "proto/wire/labels.h"

#include "proto/wire/duration.h"

namespace bccskel::wire {

v1::LabelProgress ToMessage(const LabelProgress& progress, std::chrono::nanoseconds elapsed) {
  v1::LabelProgress message;
  message.set_done(progress.done);
  message.set_total(progress.total);
  *message.mutable_elapsed() = DurationMessage(elapsed);
  return message;
}

v1::LabelType LabelTypeOf(int label_bytes) {
  for (const auto type : {v1::LABEL_TYPE_UINT8, v1::LABEL_TYPE_UINT16, v1::LABEL_TYPE_UINT32,
                          v1::LABEL_TYPE_UINT64}) {
    if (LabelBytesOf(type) == label_bytes) return type;
  }
  return v1::LABEL_TYPE_UNSPECIFIED;
}

int LabelBytesOf(v1::LabelType type) {
  switch (type) {
    case v1::LABEL_TYPE_UINT8:
      return 1;
    case v1::LABEL_TYPE_UINT16:
      return 2;
    case v1::LABEL_TYPE_UINT32:
      return 4;
    case v1::LABEL_TYPE_UINT64:
      return 8;
    default:
      return 0;
  }
}

}  // namespace bccskel::wire
