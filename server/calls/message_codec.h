#ifndef BCCSKEL_SERVER_CALLS_MESSAGE_CODEC_H_
#define BCCSKEL_SERVER_CALLS_MESSAGE_CODEC_H_

#include <string>

#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "server/durable/job_codec.h"

namespace bccskel::server {

// Encodes what DurableJobs stores as serialized messages: a VolumeDeclaration, and a
// SkeletonizeConfig with only options and thin_volume_return. Part of the library `service`.
class MessageCodec final : public JobCodec {
 public:
  explicit MessageCodec(const VolumeLimits& limits) : limits_(limits) {}

  absl::StatusOr<JobRequest> RequestOf(const std::string& declaration,
                                       const std::string& options) const override;
  std::string OptionsFor(const JobRequest& request, const std::string& options) const override;
  absl::Status WriteResult(const JobResult& result, const RecordSink& sink) const override;

 private:
  const VolumeLimits limits_;
};

// Canonical: options with the same meaning give the same bytes.
// Errors: INVALID_ARGUMENT with the field.
absl::StatusOr<std::string> OptionsBytes(const v1::SkeletonizeOptions& options,
                                         v1::ThinVolumeReturn thin_volume_return);
// The config that holds the options. Needs: bytes of OptionsBytes().
v1::SkeletonizeConfig ConfigOf(const std::string& options);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_MESSAGE_CODEC_H_
