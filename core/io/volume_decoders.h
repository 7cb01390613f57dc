#ifndef BCCSKEL_CORE_IO_VOLUME_DECODERS_H_
#define BCCSKEL_CORE_IO_VOLUME_DECODERS_H_

#include <memory>

#include "absl/status/statusor.h"
#include "core/io/volume_decoder.h"
#include "core/volume/layer_part.h"

namespace bccskel {

// The decoders of the encodings; MakeVolumeDecoder() chooses between them.
// Needs: a completed header of the encoding.

// Keeps the whole file: its chunks may lie in any order behind the tables.
std::unique_ptr<VolumeDecoder> MakeExrDecoder(const VolumeHeader& header,
                                              const VolumeLimits& limits);
// Decodes record by record. Records may come in any order, each brick once; bricks without points
// are allowed and dropped, those of other parts are checked and dropped.
std::unique_ptr<VolumeDecoder> MakeBricksDecoder(const VolumeHeader& header,
                                                 const VolumeLimits& limits,
                                                 const LayerPart& part = {});
// Decodes raw planes four rows of words at a time; never holds more of them.
std::unique_ptr<VolumeDecoder> MakePlanesDecoder(const VolumeHeader& header);
// Turns the voxels of a cubic mask into a volume, a slice at a time; never holds more of them.
absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeMaskDecoder(const VolumeHeader& header);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_DECODERS_H_
