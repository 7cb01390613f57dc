#include "server/calls/message_codec.h"

#include <string>

#include "core/exec/status_macros.h"
#include "core/pipeline/canonical_options.h"
#include "proto/wire/options.h"
#include "server/calls/requests.h"
#include "server/calls/skeleton_responses.h"

namespace bccskel::server {
absl::StatusOr<JobRequest> MessageCodec::RequestOf(const std::string& declaration,
                                                   const std::string& options) const {
  v1::SkeletonizeConfig config = ConfigOf(options);
  config.mutable_volume()->ParseFromString(declaration);
  return JobRequestOf(config, limits_);
}

std::string MessageCodec::OptionsFor(const JobRequest& request, const std::string& options) const {
  v1::SkeletonizeConfig config = ConfigOf(options);
  *config.mutable_options() = wire::ToMessage(CanonicalOptions(request.options));
  return config.SerializeAsString();
}

absl::Status MessageCodec::WriteResult(const JobResult& result, const RecordSink& sink) const {
  ResultPieces pieces(result);
  while (const auto piece = pieces.Next()) BCCSKEL_RETURN_IF_ERROR(sink(RecordOf(*piece)));
  return absl::OkStatus();
}

absl::StatusOr<std::string> OptionsBytes(const v1::SkeletonizeOptions& options,
                                         v1::ThinVolumeReturn thin_volume_return) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeOptions meant, wire::FromMessage(options, "options"));
  v1::SkeletonizeConfig config;
  *config.mutable_options() = wire::ToMessage(meant);
  const bool omitted = thin_volume_return == v1::THIN_VOLUME_RETURN_UNSPECIFIED;
  config.set_thin_volume_return(omitted ? v1::THIN_VOLUME_RETURN_OMIT : thin_volume_return);
  return config.SerializeAsString();
}

v1::SkeletonizeConfig ConfigOf(const std::string& options) {
  v1::SkeletonizeConfig config;
  config.ParseFromString(options);
  return config;
}

}  // namespace bccskel::server
