#include "server/decoding/child_channel.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

absl::Status Gone() { return absl::UnavailableError("the other end of the channel is gone"); }

bool TryLater(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

// A message of one request and room for one descriptor.
struct RequestMessage {
  explicit RequestMessage(DecodeRequest& request) : part{&request, sizeof(request)} {
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
  }

  iovec part;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control = {};
  msghdr header = {};
};

}  // namespace

absl::Status ChildChannel::WaitFor(short events, const KeepWaiting& keep_waiting) const {
  constexpr int kBetweenChecksMs = 20;
  if (keep_waiting) BCCSKEL_RETURN_IF_ERROR(keep_waiting());
  pollfd entry = {.fd = socket_.get(), .events = events, .revents = 0};
  poll(&entry, 1, keep_waiting ? kBetweenChecksMs : -1);
  return absl::OkStatus();
}

absl::Status ChildChannel::Send(std::span<const std::byte> bytes, const KeepWaiting& keep_waiting) {
  while (!bytes.empty()) {
    const ssize_t sent =
        send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && !TryLater(errno)) return Gone();
    if (sent < 0) BCCSKEL_RETURN_IF_ERROR(WaitFor(POLLOUT, keep_waiting));
    if (sent > 0) bytes = bytes.subspan(static_cast<size_t>(sent));
  }
  return absl::OkStatus();
}

absl::Status ChildChannel::Receive(std::span<std::byte> bytes, const KeepWaiting& keep_waiting) {
  while (!bytes.empty()) {
    const ssize_t received = recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (received == 0 || (received < 0 && !TryLater(errno))) return Gone();
    if (received < 0) BCCSKEL_RETURN_IF_ERROR(WaitFor(POLLIN, keep_waiting));
    if (received > 0) bytes = bytes.subspan(static_cast<size_t>(received));
  }
  return absl::OkStatus();
}

absl::Status ChildChannel::SendRequest(const DecodeRequest& request, int descriptor) {
  DecodeRequest copy = request;
  RequestMessage message(copy);
  cmsghdr* const control = CMSG_FIRSTHDR(&message.header);
  control->cmsg_level = SOL_SOCKET;
  control->cmsg_type = SCM_RIGHTS;
  control->cmsg_len = CMSG_LEN(sizeof(descriptor));
  std::memcpy(CMSG_DATA(control), &descriptor, sizeof(descriptor));
  // The socket is empty, so the message is sent whole.
  const ssize_t sent = sendmsg(socket_.get(), &message.header, MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(sizeof(request)) ? absl::OkStatus() : Gone();
}

absl::Status ChildChannel::ReceiveRequest(DecodeRequest& request, exec::Descriptor& descriptor) {
  RequestMessage message(request);
  const ssize_t received = recvmsg(socket_.get(), &message.header, MSG_WAITALL | MSG_CMSG_CLOEXEC);
  const cmsghdr* const control = CMSG_FIRSTHDR(&message.header);
  if (received != static_cast<ssize_t>(sizeof(request)) || control == nullptr) return Gone();
  int number = -1;
  std::memcpy(&number, CMSG_DATA(control), sizeof(number));
  descriptor = exec::Descriptor(number);
  return absl::OkStatus();
}

}  // namespace bccskel::server
