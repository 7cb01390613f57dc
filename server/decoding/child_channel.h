#ifndef BCCSKEL_SERVER_DECODING_CHILD_CHANNEL_H_
#define BCCSKEL_SERVER_DECODING_CHILD_CHANNEL_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>

#include "absl/status/status.h"
#include "core/exec/descriptor.h"
#include "core/io/volume_header.h"

namespace bccskel::server {

// The messages between server and child on a stream socket. Both are the same program, so structs
// travel as they lie in memory.

// Child to server, once, when the child is ready for volumes.
struct ChildHello {
  uint64_t address_space_bytes = 0;  // before the first volume
};

// Server to child, together with the descriptor of the sealed bytes.
struct DecodeRequest {
  uint64_t encoded_bytes = 0;
  VolumeLimits limits;
};

// Child to server: kTaken immediately, then one of the others, followed by `bytes` bytes.
enum class ReplyKind : uint32_t {
  kTaken,   // from here on any failure is the volume's fault
  kVolume,  // the bricks encoding
  kFault,   // a message for the caller
};
struct DecodeReply {
  ReplyKind kind = ReplyKind::kTaken;
  int32_t status_code = 0;  // for kFault
  uint64_t bytes = 0;       // number of bytes that follow
};
static_assert(std::is_trivially_copyable_v<DecodeRequest>);

// One end of the channel. Threads: one at a time.
class ChildChannel {
 public:
  explicit ChildChannel(exec::Descriptor socket) : socket_(std::move(socket)) {}

  // Called at least every 20 ms while waiting for the other end; an error ends the wait.
  using KeepWaiting = std::function<absl::Status()>;

  // Errors: UNAVAILABLE when the other end is gone; those of `keep_waiting`.
  absl::Status Send(std::span<const std::byte> bytes, const KeepWaiting& keep_waiting = {});
  absl::Status Receive(std::span<std::byte> bytes, const KeepWaiting& keep_waiting = {});

  template <typename Message>
  absl::Status SendMessage(const Message& message, const KeepWaiting& keep_waiting = {}) {
    return Send(std::as_bytes(std::span(&message, 1)), keep_waiting);
  }
  template <typename Message>
  absl::Status ReceiveMessage(Message& message, const KeepWaiting& keep_waiting = {}) {
    return Receive(std::as_writable_bytes(std::span(&message, 1)), keep_waiting);
  }
  // The same, with a descriptor attached.
  absl::Status SendRequest(const DecodeRequest& request, int descriptor);
  absl::Status ReceiveRequest(DecodeRequest& request, exec::Descriptor& descriptor);

 private:
  absl::Status WaitFor(short events, const KeepWaiting& keep_waiting) const;

  exec::Descriptor socket_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_CHANNEL_H_
