#ifndef BCCSKEL_SERVER_SERVED_CERTIFICATES_H_
#define BCCSKEL_SERVER_SERVED_CERTIFICATES_H_

#include <grpcpp/security/server_credentials.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>

#include "absl/status/statusor.h"
#include "server/identity/file_changes.h"
#include "server/identity/tls_files.h"

namespace bccskel::server {

// The certificates that new connections get: those of the last usable files. (gRPC's own watcher of
// files refuses connections while a file is wrong, and aborts the process when one is empty.)
// Needs: outlives the servers of its credentials.
class ServedCertificates {
 public:
  explicit ServedCertificates(const TlsFiles& files)
      : files_(files), changes_({files.certificate, files.key, files.client_ca}) {}

  // Reads the files if one has changed since the last call. Threads: one at a time.
  // Errors: as ReadTlsFiles(), once for each change.
  absl::StatusOr<Reload> ReloadIfChanged();

  // When the served certificate expires. Threads: any.
  std::chrono::system_clock::time_point end() const;

  // The credentials of one address. Needs: the files were read once.
  std::shared_ptr<grpc::ServerCredentials> CredentialsOfAddress();

 private:
  class Credentials;

  const TlsFiles files_;
  FileChanges changes_;
  mutable std::mutex mutex_;
  TlsBytes bytes_;           // guarded by mutex_
  uint64_t generation_ = 0;  // guarded by mutex_; of bytes_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVED_CERTIFICATES_H_
