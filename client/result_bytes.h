#ifndef BCCSKEL_CLIENT_RESULT_BYTES_H_
#define BCCSKEL_CLIENT_RESULT_BYTES_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::client {

// A result as the messages that servers send, each preceded by its length.
// Errors: those of EncodeVolume().
absl::StatusOr<std::string> ToBytes(const SkeletonizeResult& result);

// Errors: DATA_LOSS for bytes that ToBytes() does not produce.
absl::StatusOr<SkeletonizeResult> ResultFromBytes(std::string_view bytes);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_RESULT_BYTES_H_
