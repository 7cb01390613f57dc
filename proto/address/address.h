#ifndef BCCSKEL_PROTO_ADDRESS_ADDRESS_H_
#define BCCSKEL_PROTO_ADDRESS_ADDRESS_H_

#include <string>

#include "absl/status/status.h"

namespace bccskel {

inline constexpr char kUnixPrefix[] = "unix:";

// Port 0 lets the system choose one, for a server alone.
// Errors: INVALID_ARGUMENT for anything but HOST:PORT, with a port up to 65535, and unix:PATH.
//         Stricter than gRPC, which reads port 99999 as 34463 and a URL as the name of a host, and
//         which drops control characters of a host, and everything after NUL.
absl::Status CheckAddress(const std::string& address, int least_port = 0);

// The path of unix:/path or unix:///path; empty if the address is not a Unix socket.
std::string SocketPathOf(const std::string& address);

// The part of HOST:PORT before the port, as written.
std::string HostOf(const std::string& address);

// Whether traffic to the address stays on this machine: a Unix socket, localhost, 127.x.x.x or
// [::1]. Tokens need no encryption there.
bool IsOfThisMachine(const std::string& address);

}  // namespace bccskel

#endif  // BCCSKEL_PROTO_ADDRESS_ADDRESS_H_
