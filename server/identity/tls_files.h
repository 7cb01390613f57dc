#ifndef BCCSKEL_SERVER_IDENTITY_TLS_FILES_H_
#define BCCSKEL_SERVER_IDENTITY_TLS_FILES_H_

#include <chrono>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::server {

// PEM files; reloaded while the server runs.
struct TlsFiles {
  std::string certificate;  // the server's chain, its own certificate first
  std::string key;
  std::string client_ca;  // empty: clients need no certificate

  bool enabled() const { return !certificate.empty() || !key.empty() || !client_ca.empty(); }
};

// Whether a server can use these files now.
// Errors: INVALID_ARGUMENT: a file is missing, unreadable or not PEM; the key does not match the
//         certificate; the certificate has expired or is not valid yet.
absl::Status CheckTlsFiles(const TlsFiles& files);

// What the files hold, each empty if not configured.
struct TlsBytes {
  std::string certificate, key, client_ca;
  std::chrono::system_clock::time_point end;  // when the own certificate expires; 1970 if unstated
};
// Errors: as CheckTlsFiles().
absl::StatusOr<TlsBytes> ReadTlsFiles(const TlsFiles& files);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_TLS_FILES_H_
