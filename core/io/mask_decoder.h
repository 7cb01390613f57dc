#ifndef BCCSKEL_CORE_IO_MASK_DECODER_H_
#define BCCSKEL_CORE_IO_MASK_DECODER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/io/encoded_body.h"
#include "core/io/volume_decoder.h"
#include "core/mask/mask_converter.h"

namespace bccskel {

// Turns the voxels of a cubic mask into a volume, a slice at a time; never holds more of them.
class MaskDecoder final : public VolumeDecoder {
 public:
  // Needs: a completed header of a mask.
  static absl::StatusOr<std::unique_ptr<VolumeDecoder>> Create(const VolumeHeader& header);

  absl::Status Append(std::span<const std::byte> bytes) override;
  absl::StatusOr<Volume> Finish(const exec::Context& context) override;
  std::optional<BettiNumbers> mask_topology() const override { return topology_; }

 private:
  MaskDecoder(const VolumeHeader& header, MaskConverter converter);
  absl::Status AddVoxels(std::span<const std::byte> bytes);
  absl::Status FlushSlice();
  absl::Status CheckUnusedBits() const;
  // Bytes that hold the bits of the next slice.
  size_t SliceBytes() const;

  const VolumeHeader header_;
  const MaskGrid grid_;
  BodyReader body_;
  MaskConverter converter_;
  // The bits of the next slice, as far as they have arrived, from bit first_bit_ on. Slices
  // need not begin at a byte.
  std::vector<std::byte> packed_;
  size_t first_bit_ = 0;
  size_t filled_bytes_ = 0;  // of packed_
  std::vector<uint64_t> words_;
  int32_t next_z_ = 0;
  uint64_t received_bytes_ = 0;
  std::optional<BettiNumbers> topology_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_MASK_DECODER_H_
