#include "client/result_bytes.h"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "bccskel/v1/job_service.pb.h"
#include "client/skeleton_reading.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_encoder.h"
#include "proto/wire/result.h"
#include "proto/wire/skeleton_chunks.h"

namespace bccskel::client {
namespace {

namespace protobuf = google::protobuf;

// Servers send no longer pieces; Protobuf itself reads no messages above 2 GiB.
constexpr size_t kPieceBytes = 1 << 20;

class Writer {
 public:
  void Add(v1::ReadSkeletonResponse piece) {
    piece.set_piece_index(pieces_++);
    protobuf::io::StringOutputStream stream(&bytes_);
    protobuf::util::SerializeDelimitedToZeroCopyStream(piece, &stream);
  }
  std::string Take() && { return std::move(bytes_); }

 private:
  std::string bytes_;
  uint32_t pieces_ = 0;
};

}  // namespace

absl::StatusOr<std::string> ToBytes(const SkeletonizeResult& result) {
  Writer writer;
  wire::SkeletonChunkPager pager(result.graph);
  while (std::optional<v1::SkeletonChunk> chunk = pager.Next()) {
    v1::ReadSkeletonResponse piece;
    *piece.mutable_skeleton_chunk() = *std::move(chunk);
    writer.Add(std::move(piece));
  }
  std::string thin;
  if (result.thin.PointCount() > 0) {
    BCCSKEL_ASSIGN_OR_RETURN(thin,
                             EncodeVolume(result.thin, {.encoding = VolumeEncoding::kBricks,
                                                        .compression = VolumeCompression::kZstd}));
  }
  for (size_t offset = 0; offset < thin.size(); offset += kPieceBytes) {
    v1::ReadSkeletonResponse piece;
    piece.mutable_thin_volume_chunk()->set_offset(offset);
    piece.mutable_thin_volume_chunk()->set_data(thin.substr(offset, kPieceBytes));
    writer.Add(std::move(piece));
  }
  v1::ReadSkeletonResponse last;
  *last.mutable_summary() = wire::SummaryOf(result, {.thin_volume_size_bytes = thin.size(),
                                                     .algorithm_version = result.algorithm_version,
                                                     .method = result.method});
  writer.Add(std::move(last));
  return std::move(writer).Take();
}

absl::StatusOr<SkeletonizeResult> ResultFromBytes(std::string_view bytes) {
  SkeletonReading reading;
  size_t at = 0;
  while (at < bytes.size()) {
    // A separate stream for each piece, because Protobuf counts the bytes of a stream in an int.
    const size_t rest = std::min(bytes.size() - at, size_t{INT32_MAX});
    protobuf::io::ArrayInputStream stream(bytes.data() + at, static_cast<int>(rest));
    v1::ReadSkeletonResponse piece;
    bool clean_end = false;
    if (!protobuf::util::ParseDelimitedFromZeroCopyStream(&piece, &stream, &clean_end)) {
      return absl::DataLossError("a piece of the skeleton is damaged");
    }
    BCCSKEL_RETURN_IF_ERROR(reading.Add(piece));
    at += static_cast<size_t>(stream.ByteCount());
  }
  return std::move(reading).Finish();
}

}  // namespace bccskel::client
