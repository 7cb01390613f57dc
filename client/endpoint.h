#ifndef BCCSKEL_CLIENT_ENDPOINT_H_
#define BCCSKEL_CLIENT_ENDPOINT_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::client {

// PEM texts.
struct TlsMaterial {
  std::string ca;           // who may sign the server's certificate; empty: no TLS
  std::string certificate;  // the client's own chain, where the server asks for one
  std::string key;
};

// The address of a server and the credentials for it.
struct Endpoint {
  std::string address = "127.0.0.1:50051";  // HOST:PORT or unix:PATH
  TlsMaterial tls;
  std::string token;  // TokenToSend() goes with each call; empty: none

  enum class PlaintextToken { kRefuse, kAllow };
  PlaintextToken plaintext_token = PlaintextToken::kRefuse;  // over a network without TLS

  enum class Sharing { kShared, kAlone };
  Sharing sharing = Sharing::kShared;  // of one connection with others to the same address
};

enum class Encryption { kNone, kTls };

// Errors: INVALID_ARGUMENT for what is neither HOST:PORT nor unix:PATH; with TLS, HOST is enough.
absl::Status CheckAddress(const std::string& address, Encryption encryption);

// The token without the whitespace around it, such as the newline of a file.
// Errors: INVALID_ARGUMENT, without a character of it, for one that is blank or has others than the
//         visible ones of ASCII: headers of HTTP/2 cannot hold them, and gRPC aborts.
absl::StatusOr<std::string> TokenToSend(std::string_view token);

// Errors: those of CheckAddress() and TokenToSend(); FAILED_PRECONDITION for a token that would
// cross a network in the clear;
//         INVALID_ARGUMENT for a certificate without a key or TLS, or a key without a certificate.
absl::Status CheckEndpoint(const Endpoint& endpoint);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_ENDPOINT_H_
