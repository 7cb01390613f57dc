#ifndef BCCSKEL_SERVER_CALLS_SKELETON_RESPONSES_H_
#define BCCSKEL_SERVER_CALLS_SKELETON_RESPONSES_H_

#include <google/protobuf/unknown_field_set.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "proto/wire/skeleton_chunks.h"
#include "server/calls/request_sequence.h"
#include "server/durable/records.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// The first responses of a stream: the acceptance of the job, then its latest progress.
template <typename Response, typename Progress, Progress* (Response::*kProgress)()>
class FirstResponses {
 public:
  // `upload` names the upload of a durable job; empty for a job in memory.
  void Accept(const std::string& job, const std::string& upload = {}) {
    v1::SkeletonizeAccepted& accepted = accepted_.emplace();
    accepted.set_job(job);
    accepted.set_durable(!upload.empty());
    accepted.set_upload(upload);
    accepted.set_max_chunk_bytes(kMaxChunkBytes);
  }
  void Report(Progress progress) { progress_ = std::move(progress); }

  bool HasFirst() const { return accepted_.has_value() || progress_.has_value(); }
  std::optional<Response> NextFirst() {
    std::optional<Response> response;
    if (accepted_.has_value()) {
      *response.emplace().mutable_accepted() = *std::exchange(accepted_, std::nullopt);
    } else if (progress_.has_value()) {
      *(response.emplace().*kProgress)() = *std::exchange(progress_, std::nullopt);
    }
    return response;
  }

 private:
  std::optional<v1::SkeletonizeAccepted> accepted_;
  std::optional<Progress> progress_;
};
using FirstOfSkeleton = FirstResponses<v1::SkeletonizeResponse, v1::ShellProgress,
                                       &v1::SkeletonizeResponse::mutable_shell_progress>;
using FirstOfLabels = FirstResponses<v1::SkeletonizeLabelsResponse, v1::LabelProgress,
                                     &v1::SkeletonizeLabelsResponse::mutable_label_progress>;

// Splits a result into pieces of at most 256 KiB, one at a time: chunks of the skeleton, then of
// the thinned volume, then the summary.
class ResultPieces {
 public:
  // Needs: `result` outlives the pieces.
  explicit ResultPieces(const JobResult& result) : result_(result), pager_(result.skeleton.graph) {}

  // The next piece; nullopt after the summary.
  std::optional<v1::SkeletonizeResponse> Next();
  bool AtEnd() const { return at_end_; }

 private:
  const JobResult& result_;
  wire::SkeletonChunkPager pager_;
  bool in_skeleton_ = true;
  size_t thin_volume_offset_ = 0;
  bool at_end_ = false;
};

// The unsent responses of a stream. Memory is bounded however slowly the caller reads: the job has
// reserved the memory of waiting shell points, and a result is split into responses one at a time.
class SkeletonResponses : public FirstOfSkeleton {
 public:
  // A serialized v1.ShellPoints.
  void AddShellPoints(std::string points) { shell_points_.push_back(std::move(points)); }
  void Complete(JobResult result) {
    result_ = std::make_unique<JobResult>(std::move(result));
    pieces_ = std::make_unique<ResultPieces>(*result_);
  }

  // The next response, if there is one now.
  std::optional<v1::SkeletonizeResponse> Next();
  // Next() has returned the summary, the last response.
  bool AtEnd() const { return pieces_ != nullptr && pieces_->AtEnd(); }
  // Next() has another response ready.
  bool HasMore() const {
    return HasFirst() || !shell_points_.empty() || (pieces_ != nullptr && !pieces_->AtEnd());
  }

 private:
  std::deque<std::string> shell_points_;
  std::unique_ptr<JobResult> result_;
  std::unique_ptr<ResultPieces> pieces_;  // of result_
};

// The unsent responses of a stream of labels. A label is split into responses one at a time and
// released with the last one. Its job bounds the number of labels that wait here.
class LabelResponses : public FirstOfLabels {
 public:
  void Add(LabelResult label) { labels_.push_back(std::move(label)); }
  // Needs: called after the last Add().
  void Complete(LabelsResult result) { result_ = std::move(result); }

  // The next response, if there is one now.
  std::optional<v1::SkeletonizeLabelsResponse> Next();

  // Next() has returned the labels' summary, the last response.
  bool AtEnd() const { return at_end_; }
  // Next() has another response ready.
  bool HasMore() const {
    return HasFirst() || !labels_.empty() || (result_.has_value() && !at_end_);
  }

 private:
  v1::SkeletonizeLabelsResponse NextOfLabel();
  v1::SkeletonizeLabelsResponse TakeSummary();

  std::deque<LabelResult> labels_;
  std::optional<wire::SkeletonChunkPager> pager_;  // over the first of labels_, once begun
  std::optional<LabelsResult> result_;
  bool at_end_ = false;
};

// Converts a piece to its stored form.
ResultRecord RecordOf(const v1::SkeletonizeResponse& piece);

// The inverse, into any response that has these fields. Chunks are added as their wire bytes
// without being parsed: accessors of the response do not show them, but it serializes with them.
// Errors: INTERNAL for an unreadable summary, which the checksum rules out.
template <typename Response>
absl::Status SetPiece(ResultRecord record, Response& response) {
  using Kind = ResultRecord::Kind;
  if (record.kind == Kind::kSummary) {
    return response.mutable_summary()->ParseFromString(record.bytes)
               ? absl::OkStatus()
               : absl::InternalError("the summary of the result cannot be read");
  }
  const int field = record.kind == Kind::kSkeletonChunk ? Response::kSkeletonChunkFieldNumber
                                                        : Response::kThinVolumeChunkFieldNumber;
  *response.GetReflection()->MutableUnknownFields(&response)->AddLengthDelimited(field) =
      std::move(record.bytes);
  return absl::OkStatus();
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SKELETON_RESPONSES_H_
