#ifndef BCCSKEL_CLIENT_LABELS_CALL_H_
#define BCCSKEL_CLIENT_LABELS_CALL_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "client/call_options.h"
#include "client/encoded_labels.h"
#include "client/upload_call.h"
#include "core/labels/skeletonize_labels.h"
#include "proto/wire/skeleton_chunks.h"

namespace bccskel::client {

// One attempt at a SkeletonizeLabels call.
class LabelsCall final
    : private UploadCall<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse> {
 public:
  LabelsCall(grpc::ClientContext& context, Stream& stream, const LabelsCallOptions& options,
             const LabelConsumer& consume)
      : UploadCall(context, stream), options_(options), consume_(consume) {}

  // Errors: see SkeletonizeClient::SkeletonizeLabels().
  absl::StatusOr<LabelsReport> Run(const EncodedLabels& volume);

 private:
  absl::Status Take(v1::SkeletonizeLabelsResponse& response) override;
  absl::Status TakeChunk(const v1::LabelSkeletonChunk& chunk);
  absl::Status TakeLabel(const v1::LabelSummary& summary);

  const LabelsCallOptions& options_;
  const LabelConsumer& consume_;
  std::optional<uint64_t> label_;  // of the last chunk
  wire::SkeletonAssembler assembler_;
  uint64_t labels_ = 0;      // delivered
  uint64_t last_label_ = 0;  // the last of them
  std::optional<v1::LabelsSummary> summary_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_LABELS_CALL_H_
