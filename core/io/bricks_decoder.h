#ifndef BCCSKEL_CORE_IO_BRICKS_DECODER_H_
#define BCCSKEL_CORE_IO_BRICKS_DECODER_H_

#include <array>
#include <cstdint>

#include "core/io/brick_collector.h"
#include "core/io/bricks_header.h"
#include "core/io/encoded_body.h"
#include "core/io/volume_decoder.h"
#include "core/volume/layer_part.h"

namespace bccskel {

// Decodes the bricks encoding record by record. Records may come in any order, each brick once;
// bricks without points are allowed and dropped.
class BricksDecoder final : public VolumeDecoder {
 public:
  // Needs: a header of the bricks encoding. Bricks of other parts are checked and dropped.
  BricksDecoder(const VolumeHeader& header, const VolumeLimits& limits, const LayerPart& part = {})
      : header_(header),
        limits_(limits),
        part_(part),
        body_(header.compression),
        collector_(header) {}

  absl::Status Append(std::span<const std::byte> bytes) override;
  absl::StatusOr<Volume> Finish(const exec::Context& context) override;

 private:
  // Consumes bytes until `front_` holds the header, then checks it.
  absl::Status AppendFront(std::span<const std::byte>& bytes);
  absl::Status AddRecords(std::span<const std::byte> bytes);
  absl::Status AddRecord(std::span<const std::byte> record);

  VolumeHeader header_;
  VolumeLimits limits_;
  LayerPart part_;
  BodyReader body_;
  BrickCollector collector_;
  std::array<std::byte, kBricksHeaderBytes> front_;
  size_t front_bytes_ = 0;
  std::array<std::byte, kBrickRecordBytes> record_;  // a record that came in parts
  size_t record_bytes_ = 0;
  uint64_t records_ = 0;
};

// What record number `number` of an encoding says.
// Shapes: kBrickRecordBytes. Errors: INVALID_ARGUMENT.
struct BrickRecord {
  BrickKey key;
  BrickBits bits;
};
absl::StatusOr<BrickRecord> ParseBrickRecord(uint64_t number, std::span<const std::byte> record);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_BRICKS_DECODER_H_
