#ifndef BCCSKEL_CORE_IO_BRICK_ROWS_H_
#define BCCSKEL_CORE_IO_BRICK_ROWS_H_

#include <cstdint>
#include <vector>

#include "core/io/plane_rows.h"
#include "core/volume/volume.h"

namespace bccskel {

// The bricks of a volume in the order in which the dense encodings need them: the opposite of
// BrickCollector. Memory: 16 bytes a brick. The volume must outlive it.
class BrickRows {
 public:
  explicit BrickRows(const Volume& volume);

  // Writes all words of the rows, empty ones too.
  // Shapes: as BrickCollector::AddRows().
  void Fill(PlaneRowsPlace place, PlaneRows<uint32_t> rows) const;

 private:
  struct Entry {
    uint64_t rank;  // sublattice, by, channel, bx, position in the channel
    BrickIndex brick;
  };
  void FillBlock(const Entry* first, const Entry* last, PlaneRows<uint32_t> rows) const;

  const Volume& volume_;
  std::vector<Entry> entries_;  // by rank
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_BRICK_ROWS_H_
