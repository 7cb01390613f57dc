#ifndef BCCSKEL_PROTO_WIRE_OPTIONS_H_
#define BCCSKEL_PROTO_WIRE_OPTIONS_H_

#include <string>

#include "absl/status/statusor.h"
#include "bccskel/v1/options.pb.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::wire {

v1::SkeletonizeOptions ToMessage(const SkeletonizeOptions& options);

// `field` is the message's path in its request, for the error's BadRequest.
// Errors: INVALID_ARGUMENT for an enumerator that this version does not know, for columns of
//         different lengths, and for values that CheckSkeletonizeOptions() refuses.
absl::StatusOr<SkeletonizeOptions> FromMessage(const v1::SkeletonizeOptions& message,
                                               const std::string& field);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_OPTIONS_H_
