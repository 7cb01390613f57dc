#ifndef BCCSKEL_CLIENT_ENDPOINT_H_
#define BCCSKEL_CLIENT_ENDPOINT_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::client {

// Texts in PEM format.
struct TlsMaterial {
  std::string ca;           // authorities that may sign the server's certificate; empty: no TLS
  std::string certificate;  // the client's chain, if the server requires one
  std::string key;
};

// The address of a server and the credentials for it.
struct Endpoint {
  std::string address = "127.0.0.1:50051";  // HOST:PORT or unix:PATH
  TlsMaterial tls;
  std::string token;  // sent with each call, see TokenToSend(); empty: none

  enum class PlaintextToken { kRefuse, kAllow };
  PlaintextToken plaintext_token = PlaintextToken::kRefuse;  // over a network without TLS

  enum class Sharing { kShared, kAlone };
  Sharing sharing = Sharing::kShared;  // of one connection by all clients of an address
};

enum class Encryption { kNone, kTls };

// Errors: INVALID_ARGUMENT for anything but HOST:PORT and unix:PATH; with TLS, HOST is enough.
absl::Status CheckAddress(const std::string& address, Encryption encryption);

// The token without surrounding whitespace, such as the newline of a file.
// Errors: INVALID_ARGUMENT, which does not reveal the token, if it is blank or has characters other
//         than visible ASCII: HTTP/2 headers cannot hold them, and gRPC would abort.
absl::StatusOr<std::string> TokenToSend(std::string_view token);

// Errors: those of CheckAddress() and TokenToSend(); FAILED_PRECONDITION for a token that would
//         cross a network unencrypted; INVALID_ARGUMENT for a certificate without a key or without
//         TLS, or a key without a certificate.
absl::Status CheckEndpoint(const Endpoint& endpoint);

// Why a server cannot be reached, as far as gRPC's message tells.
enum class ConnectionFault {
  kNoServer,        // or nothing else is known
  kServerHasNoTls,  // it answers a client with TLS in plain text
  kNotTrusted,      // the client's authorities did not sign its certificate
  kMayWantTls       // it breaks off the connection of a client without TLS
};
// `message`: of an UNAVAILABLE error that the server did not send.
ConnectionFault ConnectionFaultOf(std::string_view message, std::string_view address,
                                  Encryption encryption);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_ENDPOINT_H_
