#include "client/skeletonize_client.h"

#include "client/retry_loop.h"
#include "core/exec/status_macros.h"

namespace bccskel::client {

absl::StatusOr<SkeletonizeResult> SkeletonizeClient::Skeletonize(const Volume& object,
                                                                 const CallOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(const EncodedVolume encoded,
                           EncodeForSending(object, BestEncodingOf(object), options.stop));
  return RetryLoop(policy_, pause_, options.timeout, options.stop).Run([&](const auto& limits) {
    return stub_->Skeletonize(encoded, options, limits.deadline);
  });
}

absl::StatusOr<LabelsReport> SkeletonizeClient::SkeletonizeLabels(const LabelVolume& volume,
                                                                  const LabelsCallOptions& options,
                                                                  const LabelConsumer& consume) {
  BCCSKEL_ASSIGN_OR_RETURN(const EncodedLabels encoded,
                           EncodeForSending(volume, options.labels, options.stop));
  RetryLoop loop(policy_, pause_, options.timeout, options.stop);
  const LabelConsumer consume_once = [&](LabelSkeleton&& skeleton) {
    loop.Stop();
    return consume(std::move(skeleton));
  };
  return loop.Run([&](const auto& limits) {
    return stub_->SkeletonizeLabels(encoded, options, consume_once, limits.deadline);
  });
}

absl::StatusOr<ServerDescription> SkeletonizeClient::Describe(std::chrono::milliseconds timeout) {
  return RetryLoop(policy_, pause_, timeout, {}).Run([&](const auto& limits) {
    return stub_->Describe(limits.deadline);
  });
}

}  // namespace bccskel::client
