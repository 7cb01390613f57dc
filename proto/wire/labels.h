#ifndef BCCSKEL_PROTO_WIRE_LABELS_H_
#define BCCSKEL_PROTO_WIRE_LABELS_H_

#include <chrono>
#include <cstdint>

#include "bccskel/v1/skeletonization_service.pb.h"
#include "bccskel/v1/volume.pb.h"

namespace bccskel::wire {

// The progress of a job with many labels.
struct LabelProgress {
  uint64_t done = 0;
  uint64_t total = 0;
};

// `elapsed` is the time since the job's computation began.
v1::LabelProgress ToMessage(const LabelProgress& progress, std::chrono::nanoseconds elapsed);

// The type of labels of 1, 2, 4 or 8 bytes; UNSPECIFIED for other sizes.
v1::LabelType LabelTypeOf(int label_bytes);
// 0 for a type that this version does not know.
int LabelBytesOf(v1::LabelType type);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_LABELS_H_
