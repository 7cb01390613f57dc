#ifndef BCCSKEL_CORE_IO_BRICK_COLLECTOR_H_
#define BCCSKEL_CORE_IO_BRICK_COLLECTOR_H_

#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/io/plane_rows.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// Gathers the occupied bricks of a volume that is being decoded and refuses more of them than its
// header allows.
class BrickCollector {
 public:
  explicit BrickCollector(const VolumeHeader& header) : header_(header) {}

  // Adds what the rows hold.
  // Shapes: nx words a row, RowsInBrickRow() rows.
  // Errors: INVALID_ARGUMENT for a set bit past the last layer, or more bricks than were declared;
  //         RESOURCE_EXHAUSTED for more bricks than the limit.
  absl::Status AddRows(PlaneRowsPlace place, PlaneRows<const uint32_t> rows);

  // Errors: the same for the number of bricks.
  absl::Status AddBrick(BrickKey key, const BrickBits& bits);

  // Errors: as Volume::Create().
  absl::StatusOr<Volume> Build() &&;

 private:
  absl::Status AddLayers(PlaneRowsPlace place, int32_t bx, const std::array<uint64_t, 32>& layers);

  VolumeHeader header_;
  std::vector<BrickKey> keys_;
  std::vector<BrickBits> bricks_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_BRICK_COLLECTOR_H_
