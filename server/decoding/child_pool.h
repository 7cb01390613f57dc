#ifndef BCCSKEL_SERVER_DECODING_CHILD_POOL_H_
#define BCCSKEL_SERVER_DECODING_CHILD_POOL_H_

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/io/volume_decoder.h"
#include "server/decoding/child_process.h"

namespace bccskel::server {

// The idle child processes. A child decodes one volume at a time, of one tenant only, and is kept
// while all of its volumes decode well. One fresh child, which has seen no tenant's bytes, is
// started ahead.
// Threads: safe.
class ChildPool {
 public:
  // `command` as for ChildProcess::Start().
  explicit ChildPool(std::vector<std::string> command);
  ChildPool(const ChildPool&) = delete;
  ChildPool& operator=(const ChildPool&) = delete;

  // Errors: as ChildProcess::Start().
  absl::StatusOr<std::unique_ptr<ChildProcess>> Take(const std::string& tenant);
  // Takes back a child whose volume decoded well. Callers destroy other children.
  void Keep(const std::string& tenant, std::unique_ptr<ChildProcess> child);
  // Starts a fresh child unless there is one.
  void StartAhead();

  // Process ids of the idle children.
  std::vector<pid_t> idle() const;

 private:
  struct Idle {
    std::string tenant;
    std::unique_ptr<ChildProcess> child;
  };
  // Needs of these: mutex_ held.
  std::unique_ptr<ChildProcess> TakeUsed(const std::string& tenant);

  const std::vector<std::string> command_;
  mutable std::mutex mutex_;
  std::deque<Idle> used_;                // guarded by mutex_; longest idle first
  std::unique_ptr<ChildProcess> fresh_;  // guarded by mutex_
};

// Decodes an OpenEXR volume in a child. Arriving bytes go to memory that the child will map; a
// child is taken only once all are there, so that slow senders occupy none.
// Needs: a completed header of OpenEXR; the pool outlives the decoder.
// Errors: a CallError; the decoder's are those of VolumeDecoder, or a CallError.
absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeChildDecoder(const VolumeHeader& header,
                                                                const VolumeLimits& limits,
                                                                const std::string& tenant,
                                                                ChildPool& pool);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_POOL_H_
