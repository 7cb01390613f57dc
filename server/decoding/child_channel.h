#ifndef BCCSKEL_SERVER_DECODING_CHILD_CHANNEL_H_
#define BCCSKEL_SERVER_DECODING_CHILD_CHANNEL_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>

#include "absl/status/status.h"
#include "core/io/volume_header.h"
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {

// What server and child say to each other, over a stream socket: they are the same program, so the
// structs travel as they lie in memory.

// Child to server, once, when it is ready for volumes.
struct ChildHello {
  uint64_t address_space_bytes = 0;  // before the first volume
};

// Server to child, with a descriptor of the sealed bytes.
struct DecodeRequest {
  uint64_t encoded_bytes = 0;
  VolumeLimits limits;
};

// Child to server: kTaken at once, then one of the others, followed by so many bytes.
enum class ReplyKind : uint32_t {
  kTaken,   // from here on what goes wrong is the volume's fault
  kVolume,  // the bricks encoding
  kFault,   // words for the caller
};
struct DecodeReply {
  ReplyKind kind = ReplyKind::kTaken;
  int32_t status_code = 0;  // of kFault
  uint64_t bytes = 0;       // that follow
};
static_assert(std::is_trivially_copyable_v<DecodeRequest>);

// One end. Threads: one at a time.
class ChildChannel {
 public:
  explicit ChildChannel(Descriptor socket) : socket_(std::move(socket)) {}

  // Asked while the other end keeps us waiting, at least every 20 ms; not OK ends the wait.
  using KeepWaiting = std::function<absl::Status()>;

  // Errors: UNAVAILABLE when the other end is gone; keep_waiting's.
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
  // The same with a descriptor beside it.
  absl::Status SendRequest(const DecodeRequest& request, int descriptor);
  absl::Status ReceiveRequest(DecodeRequest& request, Descriptor& descriptor);

 private:
  absl::Status WaitFor(short events, const KeepWaiting& keep_waiting) const;

  Descriptor socket_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_CHANNEL_H_
