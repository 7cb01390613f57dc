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

// Checks for HOST:PORT, with port 0 to 65535, or unix:PATH. gRPC would take any port modulo 65536.
absl::Status CheckAddress(const std::string& address);

// The part of HOST:PORT before the port, as written.
std::string HostOf(const std::string& address);

// The path of unix:/path or unix:///path; empty if the address is not a Unix socket.
std::string SocketPathOf(const std::string& address);

// Whether traffic to the address stays on this machine: a Unix socket, localhost, 127.x.x.x or
// [::1].
bool IsOfThisMachine(const std::string& address);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SETTINGS_VALUES_H_
