#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/io/brick_rows.h"
#include "core/io/encoded_body.h"
#include "core/io/volume_writers.h"

namespace bccskel {

absl::Status WritePlanes(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                         const exec::Context& context) {
  const LatticeExtent& extent = volume.extent();
  const auto nx = static_cast<size_t>(extent.nx);
  const BrickRows rows(volume);
  SinkCursor cursor(sink);
  BodyWriter body(compression, cursor);
  std::vector<uint32_t> words(4 * nx);
  for (Sublattice sublattice : kSublattices) {
    for (int32_t channel = 0; channel < ChannelCount(extent); ++channel) {
      BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
      for (int32_t by = 0; by < BrickRowCount(extent); ++by) {
        const size_t count = RowsInBrickRow(extent, by);
        rows.Fill({sublattice, by, channel}, {words.data(), nx, count});
        BCCSKEL_RETURN_IF_ERROR(body.Write(std::as_bytes(std::span(words).first(count * nx))));
      }
    }
  }
  return body.Finish();
}

}  // namespace bccskel
