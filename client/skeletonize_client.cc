#include "client/skeletonize_client.h"

#include "core/exec/status_macros.h"

namespace bccskel::client {

absl::StatusOr<SkeletonizeResult> SkeletonizeClient::Skeletonize(const Volume& object,
                                                                 const CallOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(const EncodedVolume encoded,
                           EncodeForSending(object, BestEncodingOf(object), options.stop));
  return connection_->Skeletonize(encoded, options);
}

absl::StatusOr<LabelsReport> SkeletonizeClient::SkeletonizeLabels(const LabelVolume& volume,
                                                                  const LabelsCallOptions& options,
                                                                  const LabelConsumer& consume) {
  BCCSKEL_ASSIGN_OR_RETURN(const EncodedLabels encoded,
                           EncodeForSending(volume, options.labels, options.stop));
  return connection_->SkeletonizeLabels(encoded, options, consume);
}

}  // namespace bccskel::client
