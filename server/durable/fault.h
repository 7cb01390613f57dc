#ifndef BCCSKEL_SERVER_DURABLE_FAULT_H_
#define BCCSKEL_SERVER_DURABLE_FAULT_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// An error that states its details: a reason as callers see it, such as SECOND_WRITER, at most one
// piece of metadata, and the field of the request that is wrong. It travels as a payload, also
// through the store; the service turns it into the messages.
struct Fault {
  std::string reason;
  std::string key = {};  // of the metadata; empty: none
  std::string value = {};
  std::string field = {};  // its path in the request; empty: none
};
inline constexpr char kDiskFull[] = "DISK_FULL";
absl::Status WithFault(absl::Status status, const Fault& fault);
std::optional<Fault> FaultOf(const absl::Status& status);

// A quota that is used up, or a full disk, as callers may see it; other errors as they are. The
// fault's value is the limit as ServerService names it.
absl::Status WithDiskFault(const absl::Status& status);

absl::Status WrongOffset(const std::string& message, uint64_t committed_bytes);
// INVALID_ARGUMENT: "<field>: <description>".
absl::Status WrongField(const std::string& field, const std::string& description);
// INVALID_ARGUMENT: the bytes of a volume are not what they should be.
absl::Status WrongVolume(const std::string& message);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FAULT_H_
