#include "server/identity/tls_files.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

using SslContext = std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)>;

absl::Status Bad(const char* flag, const std::string& path, const std::string& what) {
  ERR_clear_error();
  return absl::InvalidArgumentError(absl::StrCat(flag, ": ", path, ": ", what));
}

// Errors: INVALID_ARGUMENT if the file holds no certificates.
absl::StatusOr<SslContext> ContextOf(const std::string& certificate) {
  SslContext context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (context == nullptr) return absl::InternalError("OpenSSL cannot create a context");
  if (SSL_CTX_use_certificate_chain_file(context.get(), certificate.c_str()) == 1) return context;
  return Bad("--tls-cert", certificate, "cannot be read as a PEM certificate");
}

absl::Status CheckDates(SSL_CTX& context, const std::string& path) {
  const X509* const certificate = SSL_CTX_get0_certificate(&context);
  if (X509_cmp_current_time(X509_get0_notBefore(certificate)) > 0) {
    return Bad("--tls-cert", path, "the certificate is not valid yet");
  }
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0) {
    return Bad("--tls-cert", path, "the certificate has expired");
  }
  return absl::OkStatus();
}

absl::Status CheckPair(SSL_CTX& context, const TlsFiles& files) {
  BCCSKEL_RETURN_IF_ERROR(CheckDates(context, files.certificate));
  // Loading a key checks it against the certificate, too.
  if (SSL_CTX_use_PrivateKey_file(&context, files.key.c_str(), SSL_FILETYPE_PEM) == 1 &&
      SSL_CTX_check_private_key(&context) == 1) {
    return absl::OkStatus();
  }
  const bool other_key = ERR_GET_LIB(ERR_peek_last_error()) == ERR_LIB_X509;
  return Bad("--tls-key", files.key,
             other_key ? "is not the key of " + files.certificate
                       : "cannot be read as a PEM key without a password");
}

std::string BytesIn(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

absl::Status CheckTlsFiles(const TlsFiles& files) {
  if (!files.enabled()) return absl::OkStatus();
  if (files.certificate.empty() || files.key.empty()) {
    return absl::InvalidArgumentError("--tls-cert and --tls-key belong together");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const SslContext context, ContextOf(files.certificate));
  BCCSKEL_RETURN_IF_ERROR(CheckPair(*context, files));
  if (!files.client_ca.empty() &&
      SSL_CTX_load_verify_file(context.get(), files.client_ca.c_str()) != 1) {
    return Bad("--tls-client-ca", files.client_ca, "cannot be read as PEM certificates");
  }
  return absl::OkStatus();
}

absl::StatusOr<TlsBytes> ReadTlsFiles(const TlsFiles& files) {
  BCCSKEL_RETURN_IF_ERROR(CheckTlsFiles(files));
  return TlsBytes{.certificate = BytesIn(files.certificate),
                  .key = BytesIn(files.key),
                  .client_ca = BytesIn(files.client_ca)};
}

absl::StatusOr<std::chrono::system_clock::time_point> CertificateEnd(const TlsFiles& files) {
  BCCSKEL_ASSIGN_OR_RETURN(const SslContext context, ContextOf(files.certificate));
  std::tm end = {};
  const X509* const certificate = SSL_CTX_get0_certificate(context.get());
  if (ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &end) != 1) {
    return Bad("--tls-cert", files.certificate, "does not state when it expires");
  }
  return std::chrono::system_clock::from_time_t(timegm(&end));
}

}  // namespace bccskel::server
