#ifndef BCCSKEL_SERVER_IDENTITY_TLS_FILES_H_
#define BCCSKEL_SERVER_IDENTITY_TLS_FILES_H_

#include <chrono>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::server {

// PEM files; read again while the server runs.
struct TlsFiles {
  std::string certificate;  // the server's chain, its own certificate first
  std::string key;
  std::string client_ca;  // empty: clients show no certificate

  bool enabled() const { return !certificate.empty() || !key.empty() || !client_ca.empty(); }
};

// Whether a server can work with these files now.
// Errors: INVALID_ARGUMENT: a file is missing, cannot be read, or is not PEM; the key is not the
//         certificate's; the certificate has expired or is not valid yet.
absl::Status CheckTlsFiles(const TlsFiles& files);

// When the server's own certificate ends.
// Errors: INVALID_ARGUMENT where the file cannot be read or is not PEM.
absl::StatusOr<std::chrono::system_clock::time_point> CertificateEnd(const TlsFiles& files);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_TLS_FILES_H_
