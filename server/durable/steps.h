#ifndef BCCSKEL_SERVER_DURABLE_STEPS_H_
#define BCCSKEL_SERVER_DURABLE_STEPS_H_

#include <optional>
#include <vector>

#include "server/store/rows.h"

namespace bccskel::server {

// What a change of the store has done, for its end.

// A job's new state, and the event that tells it; none where the job had ended before.
struct Step {
  JobRow job;
  std::optional<EventRow> event;
};
// What was deleted.
struct Erased {
  std::vector<Step> steps;
  std::vector<UploadRow> uploads;  // unfinished ones
  std::vector<ResultRow> results;
  std::vector<VolumeRow> blobs;  // whose bytes no volume may have any more
  enum class Traces { kMayStay, kErase } traces = Traces::kMayStay;  // in the store's files
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_STEPS_H_
