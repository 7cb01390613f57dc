#ifndef BCCSKEL_SERVER_CALLS_RESPONSE_OUTBOX_H_
#define BCCSKEL_SERVER_CALLS_RESPONSE_OUTBOX_H_

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "bccskel/v1/skeletonization_service.pb.h"
#include "proto/wire/skeleton_chunks.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// The first response of every call.
v1::SkeletonizeAccepted AcceptedFor(const std::string& job);

// What is still to be sent on a stream. Memory is bounded however slowly the caller reads: of the
// progress only the latest is kept, points of shells wait in the memory that their job has reserved
// for them, and a result is cut into responses one at a time.
class ResponseOutbox {
 public:
  void Accept(const std::string& job) { accepted_ = AcceptedFor(job); }
  void Report(v1::ShellProgress progress) { progress_ = std::move(progress); }
  // A serialized v1.ShellPoints.
  void Peel(std::string points) { shell_points_.push_back(std::move(points)); }
  void Complete(JobResult result);

  // The next response, if there is one now.
  std::optional<v1::SkeletonizeResponse> Next();

  // The summary has been handed out: nothing will come any more.
  bool AtEnd() const { return stage_ == Stage::kEnd; }
  // Next() has another one at once.
  bool HasMore() const {
    return accepted_.has_value() || progress_.has_value() || !shell_points_.empty() ||
           (stage_ != Stage::kJob && stage_ != Stage::kEnd);
  }
  // A piece of the result, on which another one follows.
  static bool IsPiece(const v1::SkeletonizeResponse& response) {
    return response.has_skeleton_chunk() || response.has_thin_volume_chunk() ||
           response.has_shell_points();
  }

 private:
  enum class Stage { kJob, kSkeleton, kThinVolume, kSummary, kEnd };

  std::optional<v1::SkeletonizeResponse> NextOfResult();
  v1::SkeletonizeResponse NextThinVolumeChunk();
  v1::SkeletonizeResponse Summary() const;

  std::optional<v1::SkeletonizeAccepted> accepted_;
  std::optional<v1::ShellProgress> progress_;
  std::deque<std::string> shell_points_;
  Stage stage_ = Stage::kJob;
  JobResult result_;
  std::optional<wire::SkeletonChunkPager> pager_;  // over result_
  size_t thin_volume_offset_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_RESPONSE_OUTBOX_H_
