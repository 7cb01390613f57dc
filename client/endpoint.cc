#include "client/endpoint.h"

namespace bccskel::client {
namespace {

bool IsOfThisMachine(const std::string& address) {
  if (address.rfind("unix:", 0) == 0) return true;
  const std::string host = address.substr(0, address.rfind(':'));
  const bool number = host.find_first_not_of("0123456789.") == std::string::npos;
  return host == "localhost" || host == "[::1]" || (number && host.rfind("127.", 0) == 0);
}

}  // namespace

absl::Status CheckEndpoint(const Endpoint& endpoint) {
  const TlsMaterial& tls = endpoint.tls;
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
                                       " in the clear, as there is no TLS");
}

}  // namespace bccskel::client
