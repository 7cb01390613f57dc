#include "server/served_certificates.h"

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>

#include <string>

#include "core/exec/status_macros.h"

namespace bccskel::server {

// gRPC asks for a newer certificate at each new connection of the address. Without one it goes on
// with the last.
class ServedCertificates::Credentials final : public grpc::ServerCredentials {
 public:
  explicit Credentials(ServedCertificates& certificates)
      : certificates_(certificates),
        credentials_(grpc_ssl_server_credentials_create_with_options(
            grpc_ssl_server_credentials_create_options_using_config_fetcher(
                certificates.files_.client_ca.empty()
                    ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                    : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY,
                &Fetch, this))) {}
  ~Credentials() override { grpc_server_credentials_release(credentials_); }

  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {}

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }
  static grpc_ssl_certificate_config_reload_status Fetch(
      void* self, grpc_ssl_server_certificate_config** config) {
    auto& credentials = *static_cast<Credentials*>(self);
    ServedCertificates& certificates = credentials.certificates_;
    const std::lock_guard lock(certificates.mutex_);
    if (credentials.served_ == certificates.generation_) {
      return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    }
    credentials.served_ = certificates.generation_;
    const TlsBytes& bytes = certificates.bytes_;
    const grpc_ssl_pem_key_cert_pair pair = {bytes.key.c_str(), bytes.certificate.c_str()};
    // gRPC 1.51 asserts that there are authorities, even if it asks no client for a certificate.
    const std::string& authorities = bytes.client_ca.empty() ? bytes.certificate : bytes.client_ca;
    *config = grpc_ssl_server_certificate_config_create(authorities.c_str(), &pair, 1);
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

  ServedCertificates& certificates_;
  uint64_t served_ = 0;  // guarded by the certificates' mutex_: the generation that gRPC has
  grpc_server_credentials* const credentials_;
};

absl::StatusOr<Reload> ServedCertificates::ReloadIfChanged() {
  if (!changes_.Look()) return Reload::kNotNeeded;
  BCCSKEL_ASSIGN_OR_RETURN(TlsBytes bytes, ReadTlsFiles(files_));
  const std::lock_guard lock(mutex_);
  bytes_ = std::move(bytes);
  ++generation_;
  return Reload::kDone;
}

std::chrono::system_clock::time_point ServedCertificates::end() const {
  const std::lock_guard lock(mutex_);
  return bytes_.end;
}

std::shared_ptr<grpc::ServerCredentials> ServedCertificates::CredentialsOfAddress() {
  return std::make_shared<Credentials>(*this);
}

}  // namespace bccskel::server
