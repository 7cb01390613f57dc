#ifndef BCCSKEL_SERVER_STORE_STORED_STATUS_H_
#define BCCSKEL_SERVER_STORE_STORED_STATUS_H_

#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// A status with its payloads as bytes, and back. OK is the empty string.
std::string BytesOf(const absl::Status& status);
// Bytes that BytesOf() never gives yield DATA_LOSS.
absl::Status StatusOfBytes(const std::string& bytes);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_STORED_STATUS_H_
