#include "client/endpoint.h"

#include <sys/un.h>

#include <algorithm>
#include <string_view>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::client {
namespace {

constexpr std::string_view kUnix = "unix:";

bool IsOfThisMachine(const std::string& address) {
  if (address.starts_with(kUnix)) return true;
  const std::string host = address.substr(0, address.rfind(':'));
  const bool number = host.find_first_not_of("0123456789.") == std::string::npos;
  return host == "localhost" || host == "[::1]" || (number && host.rfind("127.", 0) == 0);
}

// Stricter than gRPC, which reads port 99999 as 34463, a URL as the name of a host, and a name
// alone as port 443, where servers with TLS are; which drops control characters of a host, and
// everything after NUL.
bool IsAddress(const std::string& address, Encryption encryption) {
  if (address.starts_with(kUnix)) {
    return address.size() > kUnix.size() && address.find('\0') == std::string::npos;
  }
  const size_t colon = address.rfind(':');
  const std::string host = address.substr(0, colon);
  const bool unclear = std::ranges::any_of(
      host, [](unsigned char c) { return absl::ascii_isspace(c) || absl::ascii_iscntrl(c); });
  if (host.empty() || unclear) return false;
  const std::string alone = encryption == Encryption::kTls ? "443" : "";
  const std::string port = colon == std::string::npos ? alone : address.substr(colon + 1);
  const bool digits = port.find_first_not_of("0123456789") == std::string::npos;
  const bool fits = digits && !port.empty() && port.size() <= 5 && std::stoi(port) <= 65535;
  return fits && !address.starts_with("http://") && !address.starts_with("https://");
}

absl::Status CheckPem(const std::string& text, const char* what, const char* mark) {
  if (text.empty() || text.find(mark) != std::string::npos) return absl::OkStatus();
  return absl::InvalidArgumentError(std::string(what) + " is not PEM: nothing in it ends with " +
                                    mark);
}

}  // namespace

absl::Status CheckAddress(const std::string& address, Encryption encryption) {
  constexpr size_t kLongestPath = sizeof(sockaddr_un::sun_path) - 1;
  if (address.starts_with(kUnix) && address.size() - kUnix.size() > kLongestPath) {
    return absl::InvalidArgumentError(
        absl::StrCat("'", address, "': the path of a socket has at most ", kLongestPath,
                     " characters, this one ", address.size() - kUnix.size(),
                     "; use a shorter one, such as that of a link to its folder"));
  }
  if (IsAddress(address, encryption)) return absl::OkStatus();
  return absl::InvalidArgumentError("'" + address +
                                    "' is neither HOST:PORT, with a port of 0 to 65535, nor "
                                    "unix:PATH");
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
    return absl::InvalidArgumentError("a client's certificate needs a CA for the server's");
  }
  const bool secret = endpoint.token.empty() || !tls.ca.empty() ||
                      endpoint.plaintext_token == Endpoint::PlaintextToken::kAllow ||
                      IsOfThisMachine(endpoint.address);
  if (secret) return absl::OkStatus();
  return absl::FailedPreconditionError("the token would cross the network to " + endpoint.address +
                                       " in the clear, because there is no TLS");
}

}  // namespace bccskel::client
