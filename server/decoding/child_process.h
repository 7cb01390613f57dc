#ifndef BCCSKEL_SERVER_DECODING_CHILD_PROCESS_H_
#define BCCSKEL_SERVER_DECODING_CHILD_PROCESS_H_

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"
#include "server/decoding/child_channel.h"
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {

struct DecodingBudget;

// The server's handle of a decoding child. The destructor kills the child and waits for it.
// Threads: one at a time.
class ChildProcess {
 public:
  // Returns before the child is ready. The child inherits nothing but its end of the channel,
  // ignores the signals that end the server and receives none from the terminal. `command` holds
  // the program's path, then its arguments.
  // Errors: a CallError.
  static absl::StatusOr<std::unique_ptr<ChildProcess>> Start(
      const std::vector<std::string>& command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Decodes sealed bytes whose header is `announced`. After an error the child is of no further
  // use.
  // Errors: a CallError when the child was lost before it took the volume; INVALID_ARGUMENT for
  //         malformed bytes, and for any failure of the child while it has them: a crash, an
  //         exceeded limit, an invalid answer; RESOURCE_EXHAUSTED for a volume over the limits;
  //         CANCELLED, DEADLINE_EXCEEDED.
  absl::StatusOr<Volume> Decode(const SharedBytes& bytes, const VolumeHeader& announced,
                                const VolumeLimits& limits, const exec::Context& context);

  // False once the child has ended; it has then been waited for.
  bool Lives();
  pid_t pid() const { return pid_; }

 private:
  ChildProcess(pid_t pid, exec::Descriptor channel) : pid_(pid), channel_(std::move(channel)) {}

  absl::Status BecomeReady(const ChildChannel::KeepWaiting& keep_waiting);
  absl::Status HandOver(const SharedBytes& bytes, const DecodingBudget& budget,
                        const VolumeLimits& limits, const ChildChannel::KeepWaiting& keep_waiting);
  absl::StatusOr<Volume> ReceiveVolume(const DecodeReply& reply, const VolumeHeader& announced,
                                       const exec::Context& context,
                                       const ChildChannel::KeepWaiting& keep_waiting);
  absl::Status ReceiveFault(const DecodeReply& reply,
                            const ChildChannel::KeepWaiting& keep_waiting);
  void Restrict(const DecodingBudget& budget) const;
  // The caller's error for a child that ended while it had the caller's volume.
  absl::Status Blame(const DecodingBudget& budget);

  pid_t pid_;
  ChildChannel channel_;
  bool ready_ = false;
  bool ended_ = false;
  int exit_status_ = 0;  // from waitpid(), once ended_
  uint64_t address_space_bytes_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_PROCESS_H_
