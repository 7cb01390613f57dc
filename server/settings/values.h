#ifndef BCCSKEL_SERVER_SETTINGS_VALUES_H_
#define BCCSKEL_SERVER_SETTINGS_VALUES_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

// Parse the values of settings. Errors are INVALID_ARGUMENT and state the value and the limit.

namespace bccskel::server {

absl::StatusOr<int> ParseNumber(const std::string& text, int low, int high);

// A number of bytes, optionally with a unit in powers of 1024 (KB, MB, GB, TB, also KiB and so on).
absl::StatusOr<uint64_t> ParseSize(const std::string& text, uint64_t low);

// The path of unix:/path or unix:///path; empty if the address is not a Unix socket.
std::string SocketPathOf(const std::string& address);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SETTINGS_VALUES_H_
