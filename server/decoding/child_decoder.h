#ifndef BCCSKEL_SERVER_DECODING_CHILD_DECODER_H_
#define BCCSKEL_SERVER_DECODING_CHILD_DECODER_H_

#include <memory>
#include <string>

#include "core/io/volume_decoder.h"
#include "server/decoding/child_pool.h"
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {

// Decodes an OpenEXR volume in a child. Bytes are put, as they come, where the child will find
// them; a child is taken only once all are there, so that slow senders keep none busy.
class ChildDecoder final : public VolumeDecoder {
 public:
  // Needs: a completed header of OpenEXR; the pool outlives the decoder. Errors: a CallError.
  static absl::StatusOr<std::unique_ptr<VolumeDecoder>> Create(const VolumeHeader& header,
                                                               const VolumeLimits& limits,
                                                               const std::string& tenant,
                                                               ChildPool& pool);

  // Errors: as VolumeDecoder, or a CallError.
  absl::Status Append(std::span<const std::byte> bytes) override;
  absl::StatusOr<Volume> Finish(const exec::Context& context) override;

 private:
  ChildDecoder(const VolumeHeader& header, const VolumeLimits& limits, const std::string& tenant,
               ChildPool& pool, SharedBytes bytes)
      : header_(header), limits_(limits), tenant_(tenant), pool_(pool), bytes_(std::move(bytes)) {}

  const VolumeHeader header_;
  const VolumeLimits limits_;
  const std::string tenant_;
  ChildPool& pool_;
  SharedBytes bytes_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_CHILD_DECODER_H_
