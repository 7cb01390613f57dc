#include "client/skeletonize_client.h"

#include "core/exec/status_macros.h"

namespace bccskel::client {

absl::StatusOr<SkeletonizeResult> SkeletonizeClient::Skeletonize(const Volume& object,
                                                                 const CallOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(const EncodedVolume encoded,
                           EncodeForSending(object, BestEncodingOf(object), options.stop));
  return connection_->Skeletonize(encoded, options);
}

}  // namespace bccskel::client
