#ifndef BCCSKEL_SERVER_JOBS_UPLOAD_DIGEST_H_
#define BCCSKEL_SERVER_JOBS_UPLOAD_DIGEST_H_

#include <optional>
#include <string_view>

#include "absl/status/status.h"
#include "core/digest/sha256.h"

namespace bccskel::server {

// Holds the received bytes against the digest that the sender states at the end.
class UploadDigest {
 public:
  void Add(std::string_view bytes) { sha256_.Add(bytes); }
  // Called once. Errors: INVALID_ARGUMENT for another digest than `expected`.
  absl::Status Check(const std::optional<Sha256Digest>& expected);

 private:
  Sha256 sha256_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_UPLOAD_DIGEST_H_
