#include "server/calls/message_codec.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/exec/status_macros.h"
#include "core/pipeline/canonical_options.h"
#include "proto/wire/options.h"
#include "proto/wire/result.h"
#include "proto/wire/skeleton_chunks.h"
#include "server/calls/job_request.h"

namespace bccskel::server {
namespace {

using Kind = ResultRecord::Kind;

constexpr size_t kThinVolumeChunkBytes = 256 * 1024;

absl::Status WriteThinVolume(const std::string& bytes, const JobCodec::RecordSink& sink) {
  for (size_t offset = 0; offset < bytes.size(); offset += kThinVolumeChunkBytes) {
    v1::ThinVolumeChunk chunk;
    chunk.set_offset(offset);
    chunk.set_data(bytes.substr(offset, kThinVolumeChunkBytes));
    BCCSKEL_RETURN_IF_ERROR(sink({Kind::kThinVolumeChunk, chunk.SerializeAsString()}));
  }
  return absl::OkStatus();
}

v1::SkeletonSummary SummaryOf(const JobResult& result) {
  return wire::SummaryOf(result.skeleton, {.queued = result.queued,
                                           .decoded = result.decoded,
                                           .threads = result.threads,
                                           .thin_volume_size_bytes = result.thin_volume.size(),
                                           .algorithm_version = result.skeleton.algorithm_version,
                                           .method = result.skeleton.method});
}

}  // namespace

absl::StatusOr<JobRequest> MessageCodec::RequestOf(const std::string& declaration,
                                                   const std::string& options) const {
  v1::SkeletonizeConfig config = ConfigOf(options);
  *config.mutable_volume() = DeclarationOf(declaration);
  return JobRequestOf(config, limits_);
}

std::string MessageCodec::OptionsFor(const JobRequest& request, const std::string& options) const {
  v1::SkeletonizeConfig config = ConfigOf(options);
  *config.mutable_options() = wire::ToMessage(CanonicalOptions(request.options));
  return config.SerializeAsString();
}

absl::Status MessageCodec::WriteResult(const JobResult& result, const RecordSink& sink) const {
  wire::SkeletonChunkPager pager(result.skeleton.graph);
  while (auto chunk = pager.Next()) {
    BCCSKEL_RETURN_IF_ERROR(sink({Kind::kSkeletonChunk, chunk->SerializeAsString()}));
  }
  BCCSKEL_RETURN_IF_ERROR(WriteThinVolume(result.thin_volume, sink));
  return sink({Kind::kSummary, SummaryOf(result).SerializeAsString()});
}

std::string DeclarationBytes(const v1::VolumeDeclaration& declaration) {
  return declaration.SerializeAsString();
}

v1::VolumeDeclaration DeclarationOf(const std::string& bytes) {
  v1::VolumeDeclaration declaration;
  declaration.ParseFromString(bytes);
  return declaration;
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
