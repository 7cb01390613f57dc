#ifndef BCCSKEL_TESTS_FUZZ_DURABLE_FIXTURE_H_
#define BCCSKEL_TESTS_FUZZ_DURABLE_FIXTURE_H_

#include <cstdint>
#include <cstdlib>
#include <future>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/calls/status_mapping.h"
#include "server/durable/durable_jobs.h"

// The DurableJobs that fuzz_durable.cc calls, in a temporary folder. Its jobs wait and compute
// nothing. "uploads/known", "volumes/known" and "jobs/known" stand for names that the tenant has.

namespace bccskel::server {

inline constexpr VolumeLimits kLimits = {
    .max_extent_cells = 1024, .max_bricks = 1 << 14, .max_decoded_bytes = 16 << 20};
inline const std::string kTenant = "tenant";

inline void Insist(bool holds) {
  if (!holds) std::abort();
}

// One for the process: each call leaves it as it found it, but for `known` ones.
DurableJobs& TheJobs();

// What the callback is given, as the caller hears of it.
template <typename Value, typename Call>
absl::StatusOr<Value> Ask(Call call) {
  std::promise<absl::StatusOr<Value>> promise;
  call([&](absl::StatusOr<Value> value) { promise.set_value(std::move(value)); });
  absl::StatusOr<Value> answer = promise.get_future().get();
  if (!answer.ok()) return StorageError(answer.status());
  return answer;
}

template <typename Call>
absl::Status Tell(Call call) {
  std::promise<absl::Status> promise;
  call([&](absl::Status status) { promise.set_value(std::move(status)); });
  return StorageError(promise.get_future().get());
}

// The upload of that name, or a new one. Create(): "volumes/known" is the known volume.
absl::StatusOr<UploadInfo> Upload(const NewUpload& wanted);
absl::StatusOr<JobInfo> Create(NewJob job);
absl::Status DeleteUpload(const std::string& upload);
absl::Status DeleteJob(const std::string& job);

// The names behind the known ones, which exist; other names as they are.
const std::string& VolumeNamed(const std::string& name);
const std::string& JobNamed(const std::string& name);

// As above, for calls that end what they name: each known one is made anew.
std::string SpareJob(const std::string& name);
std::string SpareUpload(const std::string& name);

}  // namespace bccskel::server

#endif  // BCCSKEL_TESTS_FUZZ_DURABLE_FIXTURE_H_
