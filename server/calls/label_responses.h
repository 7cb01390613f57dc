#ifndef BCCSKEL_SERVER_CALLS_LABEL_RESPONSES_H_
#define BCCSKEL_SERVER_CALLS_LABEL_RESPONSES_H_

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "bccskel/v1/skeletonization_service.pb.h"
#include "proto/wire/skeleton_chunks.h"
#include "server/calls/skeleton_responses.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// What is still to be sent on a stream of labels. Of the progress only the latest is kept; a label
// is cut into responses one at a time and let go of with the last one. How many labels wait here is
// bounded by their job.
class LabelResponses {
 public:
  void Accept(const std::string& job) { accepted_ = AcceptedFor(job); }
  void Report(v1::LabelProgress progress) { progress_ = std::move(progress); }
  void Add(LabelResult label) { labels_.push_back(std::move(label)); }
  // Needs: comes after the last Add().
  void Complete(LabelsResult result) { result_ = std::move(result); }

  // The next response, if there is one now.
  std::optional<v1::SkeletonizeLabelsResponse> Next();

  // The labels' summary has been handed out: nothing will come any more.
  bool AtEnd() const { return at_end_; }
  // Next() has another one at once.
  bool HasMore() const {
    return accepted_.has_value() || progress_.has_value() || !labels_.empty() ||
           (result_.has_value() && !at_end_);
  }

 private:
  v1::SkeletonizeLabelsResponse NextOfLabel();
  v1::SkeletonizeLabelsResponse TakeSummary();

  std::optional<v1::SkeletonizeAccepted> accepted_;
  std::optional<v1::LabelProgress> progress_;
  std::deque<LabelResult> labels_;
  std::optional<wire::SkeletonChunkPager> pager_;  // over the first of labels_, once begun
  std::optional<LabelsResult> result_;
  bool at_end_ = false;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_LABEL_RESPONSES_H_
