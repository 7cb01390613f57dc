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

// Children at hand. A child decodes one volume at a time and only volumes of one tenant; it is kept
// while all of them decode well. A fresh one, which has seen no byte of anyone, is started ahead.
// Threads: safe.
class ChildPool {
 public:
  // `command` as of ChildProcess::Start().
  explicit ChildPool(std::vector<std::string> command);
  ChildPool(const ChildPool&) = delete;
  ChildPool& operator=(const ChildPool&) = delete;

  // Errors: as ChildProcess::Start().
  absl::StatusOr<std::unique_ptr<ChildProcess>> Take(const std::string& tenant);
  // After a volume that decoded well. Other children are simply dropped.
  void Keep(const std::string& tenant, std::unique_ptr<ChildProcess> child);
  // Starts a fresh child unless there is one.
  void StartAhead();

  // Process ids of those that wait for a volume.
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
  std::deque<Idle> used_;                // guarded by mutex_; the longest idle first
  std::unique_ptr<ChildProcess> fresh_;  // guarded by mutex_
};

// Decodes an OpenEXR volume in a child. Bytes are put, as they come, where the child will find
// them; a child is taken only once all are there, so that slow senders keep none busy.
// Needs: a completed header of OpenEXR; the pool outlives the decoder.
// Errors, its own too: as VolumeDecoder, or a CallError.
absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeChildDecoder(const VolumeHeader& header,
                                                                const VolumeLimits& limits,
                                                                const std::string& tenant,
                                                                ChildPool& pool);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_POOL_H_
