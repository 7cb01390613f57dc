#include "client/endpoint.h"

#include <sys/un.h>

#include <algorithm>
#include <string_view>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/address/address.h"

namespace bccskel::client {
namespace {

absl::Status CheckPem(const std::string& text, const char* what, const char* mark) {
  if (text.empty() || text.find(mark) != std::string::npos) return absl::OkStatus();
  return absl::InvalidArgumentError(std::string(what) + " is not PEM: nothing in it ends with " +
                                    mark);
}

}  // namespace

absl::Status CheckAddress(const std::string& address, Encryption encryption) {
  constexpr size_t kLongestPath = sizeof(sockaddr_un::sun_path) - 1;
  constexpr size_t kPrefix = sizeof(kUnixPrefix) - 1;
  if (address.starts_with(kUnixPrefix) && address.size() - kPrefix > kLongestPath) {
    return absl::InvalidArgumentError(
        absl::StrCat("'", address, "': the path of a socket has at most ", kLongestPath,
                     " characters, this one ", address.size() - kPrefix,
                     "; use a shorter one, such as that of a link to its folder"));
  }
  // gRPC takes a host alone for its port 443, where servers with TLS are.
  const bool alone = address.find(':') == std::string::npos && encryption == Encryption::kTls;
  if (alone && bccskel::CheckAddress(address + ":443").ok()) return absl::OkStatus();
  constexpr int kLeastPort = 1;
  return bccskel::CheckAddress(address, kLeastPort);
}

absl::StatusOr<std::string> TokenToSend(std::string_view token) {
  std::string inner(token);
  absl::StripAsciiWhitespace(&inner);
  if (inner.empty() && !token.empty()) return absl::InvalidArgumentError("the token is blank");
  if (std::ranges::all_of(inner, [](unsigned char c) { return absl::ascii_isgraph(c); })) {
    return inner;
  }
  return absl::InvalidArgumentError("the token contains a character that is not visible ASCII");
}

absl::Status CheckEndpoint(const Endpoint& endpoint) {
  const TlsMaterial& tls = endpoint.tls;
  BCCSKEL_RETURN_IF_ERROR(TokenToSend(endpoint.token).status());
  BCCSKEL_RETURN_IF_ERROR(
      CheckAddress(endpoint.address, tls.ca.empty() ? Encryption::kNone : Encryption::kTls));
  BCCSKEL_RETURN_IF_ERROR(CheckPem(tls.ca, "the file of authorities", "CERTIFICATE-----"));
  BCCSKEL_RETURN_IF_ERROR(CheckPem(tls.certificate, "the certificate", "CERTIFICATE-----"));
  BCCSKEL_RETURN_IF_ERROR(CheckPem(tls.key, "the key", "PRIVATE KEY-----"));
  if (tls.certificate.empty() != tls.key.empty()) {
    return absl::InvalidArgumentError("a client's certificate and its key belong together");
  }
  if (!tls.certificate.empty() && tls.ca.empty()) {
    return absl::InvalidArgumentError(
        "a client's certificate needs the authority that signed the server's");
  }
  const bool secret = endpoint.token.empty() || !tls.ca.empty() ||
                      endpoint.plaintext_token == Endpoint::PlaintextToken::kAllow ||
                      IsOfThisMachine(endpoint.address);
  if (secret) return absl::OkStatus();
  return absl::FailedPreconditionError("the token would cross the network to " + endpoint.address +
                                       " in the clear, because there is no TLS");
}

ConnectionFault ConnectionFaultOf(std::string_view message, std::string_view address,
                                  Encryption encryption) {
  std::string lower(message);
  absl::AsciiStrToLower(&lower);
  const auto tells = [&lower](std::string_view what) {
    return lower.find(what) != std::string::npos;
  };
  if (encryption == Encryption::kTls) {
    if (tells("certificate verify failed")) return ConnectionFault::kNotTrusted;
    const bool plain = tells("wrong version number") || tells("wrong_version_number");
    return plain ? ConnectionFault::kServerHasNoTls : ConnectionFault::kNoServer;
  }
  // Something listens there but does not respond like a server.
  const bool breaks_off =
      tells("failed to connect") && !tells("to remote host") && !tells("timeout");
  return breaks_off && !address.starts_with(kUnixPrefix) ? ConnectionFault::kMayWantTls
                                                         : ConnectionFault::kNoServer;
}

}  // namespace bccskel::client
