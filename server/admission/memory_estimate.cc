#include "server/admission/memory_estimate.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <iterator>
#include <span>
#include <vector>

#include "core/io/encoded_body.h"

namespace bccskel::server {
namespace {

uint64_t PipelineBytes(uint64_t bricks) {
  return SaturatingMultiply(bricks, kPipelineBytesPerBrick);
}

// Memory per run while its label grows: a vector that doubles occupies up to three times its
// contents.
constexpr uint64_t kBytesPerRun = 3 * sizeof(VoxelRun);
// A label's entry in tables and its part of the allocator's slack.
constexpr uint64_t kBytesPerLabel = sizeof(LabeledObject) + 128;
// Per label being computed: stacks, small tables and the allocator's slack.
constexpr uint64_t kFixedBytesPerLabel = 64 * 1024;

// Parts of voxels per brick: 25 in tubes four voxels across, 200 in solid blobs.
constexpr uint64_t kPartsPerBrick = 25;
// Per thread: enough bricks for dozens of small labels, so that a turn is worth its overhead.
constexpr uint64_t kLeastBricks = 4096;

uint64_t ValueOr(uint64_t stated, uint64_t worst) {
  return stated > 0 ? std::min(stated, worst) : worst;
}

// The number of nonzero values of a voxel of this many bytes.
uint64_t LabelsOfType(int bytes) {
  return bytes == 8 ? ~uint64_t{0} : (uint64_t{1} << (8 * bytes)) - 1;
}

// The columns of bricks, within one layer, that an object touches: each voxel has its parts, and
// its far corner touches the next voxel.
class BrickLayer {
 public:
  BrickLayer(const VoxelBox& box, const VoxelParts& parts, CavityFilling cavities)
      : parts_(parts),
        cavities_(cavities),
        first_x_(parts[0] * box.low[0] / kBrickX),
        first_y_(parts[1] * box.low[1] / kBrickY),
        words_per_row_(static_cast<size_t>(parts[0] * box.high[0] / kBrickX - first_x_) / 64 + 1),
        bits_(words_per_row_ *
              static_cast<size_t>(parts[1] * box.high[1] / kBrickY - first_y_ + 1)) {}

  void Add(const VoxelRun& run) {
    const int32_t last = parts_[1] * (run.y + 1) / kBrickY;
    for (int32_t by = parts_[1] * run.y / kBrickY; by <= last; ++by) AddRow(by, run);
  }

  uint64_t TakeCount() {
    uint64_t count = 0;
    for (size_t begin = 0; begin < bits_.size(); begin += words_per_row_) {
      count += CountRow(std::span(bits_).subspan(begin, words_per_row_));
    }
    std::ranges::fill(bits_, 0);
    return count;
  }

 private:
  void AddRow(int32_t by, const VoxelRun& run) {
    uint64_t* const row = &bits_[static_cast<size_t>(by - first_y_) * words_per_row_];
    const int32_t last = parts_[0] * run.end / kBrickX;
    for (int32_t bx = parts_[0] * run.begin / kBrickX; bx <= last; ++bx) {
      const auto bit = static_cast<size_t>(bx - first_x_);
      row[bit / 64] |= uint64_t{1} << bit % 64;
    }
  }

  uint64_t CountRow(std::span<const uint64_t> row) const {
    uint64_t bricks = 0, first = row.size() * 64, last = 0;
    for (size_t n = 0; n < row.size(); ++n) {
      if (row[n] == 0) continue;
      bricks += static_cast<uint64_t>(std::popcount(row[n]));
      first = std::min<uint64_t>(first, 64 * n + static_cast<uint64_t>(std::countr_zero(row[n])));
      last = 64 * n + 63 - static_cast<uint64_t>(std::countl_zero(row[n]));
    }
    return cavities_ == CavityFilling::kOn && bricks > 0 ? last - first + 1 : bricks;
  }

  VoxelParts parts_;
  CavityFilling cavities_;
  int32_t first_x_, first_y_;
  size_t words_per_row_;
  std::vector<uint64_t> bits_;
};

}  // namespace

uint64_t BytesToSkeletonize(const VolumeHeader& declared, uint64_t size_bytes,
                            ShellPointsWanted shell_points) {
  const uint64_t received = SaturatingAdd(declared.DecodingBytes(size_bytes), kFixedJobBytes);
  return SaturatingAdd(SaturatingAdd(received, PipelineBytes(declared.max_bricks)),
                       ShellPointsBytes(shell_points, declared.max_bricks));
}

uint64_t BytesToSkeletonize(const Volume& volume, ShellPointsWanted shell_points) {
  return kFixedJobBytes + PipelineBytes(volume.brick_count()) +
         ShellPointsBytes(shell_points, volume.brick_count());
}

int ThreadsFor(uint64_t bricks, int wanted, int threads) {
  if (bricks <= kSmallJobBricks) return 1;
  return ThreadsWithin(threads, wanted);
}

int ThreadsWithin(int threads, int wanted) {
  return wanted > 0 ? std::min(wanted, threads) : threads;
}

uint64_t LabelVolumeHeader::DecodedBytes() const {
  return SaturatingMultiply(
      SaturatingMultiply(grid.VoxelsPerSlice(), static_cast<uint64_t>(grid.nz)),
      static_cast<uint64_t>(label_bytes));
}

LabelVolumeHeader WithWorstCase(LabelVolumeHeader header, uint64_t labels_wanted) {
  const uint64_t voxels = header.DecodedBytes() / static_cast<uint64_t>(header.label_bytes);
  header.max_voxels = ValueOr(header.max_voxels, voxels);
  header.max_label_voxels = ValueOr(header.max_label_voxels, header.max_voxels);
  header.max_runs = ValueOr(header.max_runs, header.max_voxels);
  header.max_labels =
      labels_wanted > 0
          ? labels_wanted
          : ValueOr(header.max_labels, std::min(header.max_runs, LabelsOfType(header.label_bytes)));
  return header;
}

uint64_t BytesToComputeLabels(const LabelVolumeHeader& declared, int threads) {
  const uint64_t at_work =
      std::min(SaturatingMultiply(declared.max_label_voxels, static_cast<uint64_t>(threads)),
               declared.max_voxels);
  const auto [px, py, pz] = PartsOf(declared.grid, declared.points);
  const uint64_t parts = SaturatingMultiply(at_work, static_cast<uint64_t>(px * py * pz));
  const uint64_t bricks =
      SaturatingAdd(parts / kPartsPerBrick, kLeastBricks * static_cast<uint64_t>(threads));
  const uint64_t box = BoxBrickCount(ExactExtent(declared.grid, declared.points));
  return BytesToComputeLabel(std::min(bricks, std::max(box, kLeastBricks)));
}

uint64_t BytesToSkeletonizeLabels(const LabelVolumeHeader& declared, int threads) {
  const auto label_bytes = static_cast<uint64_t>(declared.label_bytes);
  const uint64_t slice =
      SaturatingMultiply(declared.grid.VoxelsPerSlice(), label_bytes + sizeof(uint64_t));
  // Promises are enforced row by row.
  const uint64_t runs = SaturatingAdd(declared.max_runs, static_cast<uint64_t>(declared.grid.nx));
  const uint64_t labels =
      SaturatingAdd(declared.max_labels, static_cast<uint64_t>(declared.grid.nx));
  uint64_t bytes = kFixedJobBytes + BodyBufferBytes(declared.compression);
  bytes = SaturatingAdd(bytes, slice);
  bytes = SaturatingAdd(bytes, SaturatingMultiply(runs, kBytesPerRun));
  bytes = SaturatingAdd(bytes, SaturatingMultiply(labels, kBytesPerLabel));
  return SaturatingAdd(bytes, BytesToComputeLabels(declared, threads));
}

uint64_t MostBricksOf(const LabeledObject& object, const VoxelParts& parts,
                      CavityFilling cavities) {
  if (object.runs.empty()) return 0;
  uint64_t bricks = 0;
  int32_t bz = parts[2] * object.runs.front().z / kBrickZ;  // of the first layer
  std::deque<BrickLayer> layers;
  for (const VoxelRun& run : object.runs) {
    const int32_t first = parts[2] * run.z / kBrickZ, last = parts[2] * (run.z + 1) / kBrickZ;
    for (; bz < first; ++bz) {
      if (layers.empty()) continue;
      bricks += layers.front().TakeCount();
      layers.pop_front();
    }
    while (bz + std::ssize(layers) <= last) layers.emplace_back(object.box, parts, cavities);
    for (int32_t layer = first; layer <= last; ++layer) {
      layers[static_cast<size_t>(layer - bz)].Add(run);
    }
  }
  for (BrickLayer& layer : layers) bricks += layer.TakeCount();
  return 2 * bricks;
}

uint64_t BytesToComputeLabel(uint64_t bricks) {
  return SaturatingAdd(SaturatingMultiply(bricks, kPipelineBytesPerBrick), kFixedBytesPerLabel);
}

uint64_t BytesOf(const LabeledObject& object) {
  return kBytesPerLabel + object.runs.capacity() * sizeof(VoxelRun);
}

}  // namespace bccskel::server
