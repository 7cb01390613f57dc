#ifndef BCCSKEL_CLIENT_UPLOAD_CALL_H_
#define BCCSKEL_CLIENT_UPLOAD_CALL_H_

#include <grpcpp/grpcpp.h>
#include <grpcpp/support/sync_stream.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "client/grpc_status.h"
#include "core/digest/sha256.h"

namespace bccskel::client {

// The names that the server states when it accepts a durable Skeletonize call.
struct AcceptedCall {
  std::string upload;
  std::string job;
};

// One call that uploads a volume, from its first to its last message, on the calling thread.
template <typename Request, typename Response>
class UploadCall {
 public:
  using Clock = std::chrono::steady_clock;
  using Stream = grpc::ClientReaderWriterInterface<Request, Response>;

  // Needs: both outlive the call.
  UploadCall(grpc::ClientContext& context, Stream& stream) : context_(context), stream_(stream) {}
  virtual ~UploadCall() = default;

 protected:
  // Errors: the server's; DATA_LOSS; those of Take(), which cancel the call.
  absl::Status Converse(const Request& config, const std::string& bytes) {
    // A failed write means that the call has ended; Finish() yields the reason.
    const bool sent = stream_.Write(config) && ReadAccepted() && SendVolume(bytes);
    sent_at_ = Clock::now();
    if (sent) ReadReplies();
    const grpc::Status ended = stream_.Finish();
    return reply_error_.ok() ? FromGrpcStatus(ended) : reply_error_;
  }

  // Time until everything was sent.
  Clock::duration UploadTime() const { return sent_at_ - started_at_; }

  // The names of the stored upload and job, if the server keeps them; else empty.
  const AcceptedCall& accepted() const { return accepted_; }

  // Handles one reply after the first.
  virtual absl::Status Take(Response& response) = 0;

 private:
  bool ReadAccepted() {
    Response response;
    if (!stream_.Read(&response)) return false;
    if (!response.has_accepted()) {
      // Such a server may wait for the volume until the deadline.
      return Fail(absl::DataLossError("the server's first reply does not accept the job"));
    }
    if (response.accepted().durable()) {
      accepted_ = {.upload = response.accepted().upload(), .job = response.accepted().job()};
    }
    constexpr size_t kChunkBytes = 512 * 1024;
    chunk_bytes_ = std::min<size_t>(kChunkBytes, response.accepted().max_chunk_bytes());
    return true;
  }

  bool SendVolume(const std::string& bytes) {
    Request request;
    for (size_t offset = 0; offset < bytes.size() && chunk_bytes_ > 0; offset += chunk_bytes_) {
      request.mutable_chunk()->set_offset(offset);
      request.mutable_chunk()->set_data(bytes.substr(offset, chunk_bytes_));
      // More follows immediately: the hint sends small volumes in one write to the socket.
      if (!stream_.Write(request, grpc::WriteOptions().set_buffer_hint())) return false;
    }
    const Sha256Digest digest = Sha256Of(bytes);
    request.mutable_finish()->set_size_bytes(bytes.size());
    request.mutable_finish()->set_sha256(digest.bytes.data(), digest.bytes.size());
    return stream_.Write(request, grpc::WriteOptions().set_last_message());
  }

  void ReadReplies() {
    Response response;
    while (reply_error_.ok() && stream_.Read(&response)) {
      if (absl::Status taken = Take(response); !taken.ok()) Fail(taken);
    }
  }

  bool Fail(const absl::Status& status) {
    reply_error_ = status;
    context_.TryCancel();
    return false;
  }

  grpc::ClientContext& context_;
  Stream& stream_;
  const Clock::time_point started_at_ = Clock::now();
  Clock::time_point sent_at_ = started_at_;
  size_t chunk_bytes_ = 0;
  AcceptedCall accepted_;
  absl::Status reply_error_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_UPLOAD_CALL_H_
