#include "server/jobs/upload_digest.h"

#include "absl/strings/str_format.h"

namespace bccskel::server {

absl::Status UploadDigest::Check(const std::optional<Sha256Digest>& expected) {
  const Sha256Digest found = sha256_.Finish();
  if (!expected.has_value() || *expected == found) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("the received bytes have the SHA-256 digest %s, the request states %s",
                      found.Hex(), expected->Hex()));
}

}  // namespace bccskel::server
