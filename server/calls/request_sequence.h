#ifndef BCCSKEL_SERVER_CALLS_REQUEST_SEQUENCE_H_
#define BCCSKEL_SERVER_CALLS_REQUEST_SEQUENCE_H_

#include <cstddef>
#include <cstdint>

#include "absl/status/status.h"
#include "bccskel/v1/volume.pb.h"

namespace bccskel::server {

inline constexpr size_t kMaxChunkBytes = size_t{1} << 20;

// Checks the order of a stream's requests: config, chunks without gaps, finish, half-close.
class RequestSequence {
 public:
  // Checks the next request (config, chunk or finish) against the previous ones and the declared
  // size.
  // Errors: INVALID_ARGUMENT for a request out of order, a chunk or a volume of a wrong size;
  //         OUT_OF_RANGE, with the committed size, for a chunk with a wrong offset.
  template <typename Request>
  absl::Status Take(const Request& request) {
    switch (request.request_case()) {
      case Request::kConfig:
        return TakeConfig(request.config().volume().size_bytes());
      case Request::kChunk:
        return TakeChunk(request.chunk());
      case Request::kFinish:
        return TakeFinish(request.finish());
      case Request::REQUEST_NOT_SET:
        break;
    }
    return UnknownRequest();
  }

  // The caller sends no more.
  // Errors: INVALID_ARGUMENT before finish.
  absl::Status HalfClose() const;

  // `committed_bytes` arrived before this stream. Needs: called after the config and before the
  // first chunk.
  void ResumeAt(uint64_t committed_bytes) { committed_bytes_ = committed_bytes; }

  bool finished() const { return expected_ == Expected::kNothing; }

 private:
  enum class Expected { kConfig, kBytes, kNothing };

  absl::Status TakeConfig(uint64_t declared_bytes);
  absl::Status TakeChunk(const v1::VolumeChunk& chunk);
  absl::Status TakeFinish(const v1::VolumeFinish& finish);
  static absl::Status UnknownRequest();
  absl::Status CheckExpected(Expected expected, const char* request) const;

  Expected expected_ = Expected::kConfig;
  uint64_t declared_bytes_ = 0;
  uint64_t committed_bytes_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_REQUEST_SEQUENCE_H_
