#ifndef BCCSKEL_CORE_IO_PLANES_DECODER_H_
#define BCCSKEL_CORE_IO_PLANES_DECODER_H_

#include <cstdint>
#include <vector>

#include "core/io/brick_collector.h"
#include "core/io/encoded_body.h"
#include "core/io/plane_rows.h"
#include "core/io/volume_decoder.h"

namespace bccskel {

// Decodes raw planes four rows of words at a time; never holds more of them.
class PlanesDecoder final : public VolumeDecoder {
 public:
  // Needs: a header of raw planes.
  explicit PlanesDecoder(const VolumeHeader& header);

  absl::Status Append(std::span<const std::byte> bytes) override;
  absl::StatusOr<Volume> Finish(const exec::Context& context) override;

 private:
  absl::Status AddWords(std::span<const std::byte> bytes);
  absl::Status FlushRows();
  void StepToNextRows();
  size_t RowsBytes() const;  // of the rows at place_
  bool Complete() const { return received_bytes_ == header_.decoded_bytes; }

  VolumeHeader header_;
  BodyReader body_;
  BrickCollector collector_;
  PlaneRowsPlace place_;
  std::vector<uint32_t> words_;  // the rows at place_, as far as they have arrived
  size_t filled_bytes_ = 0;      // of words_
  uint64_t received_bytes_ = 0;  // of all planes
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_PLANES_DECODER_H_
