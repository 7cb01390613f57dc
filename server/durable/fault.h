#ifndef BCCSKEL_SERVER_DURABLE_FAULT_H_
#define BCCSKEL_SERVER_DURABLE_FAULT_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// An error that states its ErrorInfo: a reason as callers see it, such as SECOND_WRITER, and at
// most one piece of metadata. It travels as a payload, also through the store; the service turns it
// into the message.
struct Fault {
  std::string reason;
  std::string key;  // of the metadata; empty: none
  std::string value;
};
inline constexpr char kDiskFull[] = "DISK_FULL";
absl::Status WithFault(absl::Status status, const Fault& fault);
std::optional<Fault> FaultOf(const absl::Status& status);

// A quota that is used up, or a full disk, as callers may see it; other errors as they are. The
// fault's value is the limit as ServerService names it.
absl::Status WithDiskFault(const absl::Status& status);

absl::Status WrongOffset(const std::string& message, uint64_t committed_bytes);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FAULT_H_
