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

absl::Status LoadPair(SSL_CTX& context, const TlsFiles& files) {
  if (SSL_CTX_use_certificate_chain_file(&context, files.certificate.c_str()) != 1) {
    return Bad("--tls-cert", files.certificate, "cannot be read as a PEM certificate");
  }
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

// Errors: as CheckTlsFiles().
absl::StatusOr<SslContext> ContextOf(const TlsFiles& files) {
  if (files.certificate.empty() || files.key.empty()) {
    return absl::InvalidArgumentError("--tls-cert and --tls-key belong together");
  }
  SslContext context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (context == nullptr) return absl::InternalError("OpenSSL cannot create a context");
  BCCSKEL_RETURN_IF_ERROR(LoadPair(*context, files));
  if (!files.client_ca.empty() &&
      SSL_CTX_load_verify_file(context.get(), files.client_ca.c_str()) != 1) {
    return Bad("--tls-client-ca", files.client_ca, "cannot be read as PEM certificates");
  }
  return context;
}

// 1970 if it does not say.
std::chrono::system_clock::time_point EndOf(const X509* certificate) {
  std::tm end = {};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &end) != 1) return {};
  return std::chrono::system_clock::from_time_t(timegm(&end));
}

std::string BytesIn(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

absl::Status CheckTlsFiles(const TlsFiles& files) {
  return files.enabled() ? ContextOf(files).status() : absl::OkStatus();
}

absl::StatusOr<TlsBytes> ReadTlsFiles(const TlsFiles& files) {
  BCCSKEL_ASSIGN_OR_RETURN(const SslContext context, ContextOf(files));
  return TlsBytes{.certificate = BytesIn(files.certificate),
                  .key = BytesIn(files.key),
                  .client_ca = BytesIn(files.client_ca),
                  .end = EndOf(SSL_CTX_get0_certificate(context.get()))};
}

}  // namespace bccskel::server
