#include "server/admission/memory_estimate.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "core/io/encoded_body.h"

namespace bccskel::server {
namespace {

uint64_t PipelineBytes(uint64_t bricks) {
  return SaturatingMultiply(bricks, kPipelineBytesPerBrick);
}

// Memory of a run while its label grows: a vector that doubles holds three times its contents.
constexpr uint64_t kBytesPerRun = 3 * sizeof(VoxelRun);
// A label's entry in tables and its part of the allocator's slack.
constexpr uint64_t kBytesPerLabel = sizeof(LabeledObject) + 128;
// Stacks, small tables and the allocator's slack of one label at work.
constexpr uint64_t kFixedBytesPerLabel = 64 * 1024;

// Tubes of four voxels across have a brick for every 25 voxels, solid blobs for 200. Refined voxels
// fill eight times as many.
constexpr uint64_t kVoxelsPerBrick = 25;
constexpr uint64_t kRefinedVoxelsPerBrick = 4;
// For each thread: dozens of small labels, so that a turn is worth its beginning and its end.
constexpr uint64_t kLeastBricks = 4096;

uint64_t ValueOr(uint64_t stated, uint64_t worst) {
  return stated > 0 ? std::min(stated, worst) : worst;
}

// Numbers that a voxel of so many bytes can hold, without 0.
uint64_t LabelsOfType(int bytes) {
  return bytes == 8 ? ~uint64_t{0} : (uint64_t{1} << (8 * bytes)) - 1;
}

// The voxels that a brick spans.
struct BlockSize {
  int32_t x = kBrickX;
  int32_t y = kBrickY;
  int32_t z = kBrickZ;
};
BlockSize BlockSizeOf(VoxelPoints points) {
  if (points == VoxelPoints::kTwo) return {};
  return {kBrickX / 2, kBrickY / 2, kBrickZ / 2};
}

// The columns of blocks, over one layer of them, that an object touches: a voxel belongs to its own
// block and touches the next one with its far corner.
class BlockLayer {
 public:
  BlockLayer(const VoxelBox& box, const BlockSize& size, CavityFilling cavities)
      : size_(size),
        cavities_(cavities),
        first_x_(box.low[0] / size.x),
        first_y_(box.low[1] / size.y),
        words_per_row_(static_cast<size_t>(box.high[0] / size.x - first_x_) / 64 + 1),
        bits_(words_per_row_ * static_cast<size_t>(box.high[1] / size.y - first_y_ + 1)) {}

  void Add(const VoxelRun& run) {
    AddRow(run.y / size_.y, run);
    if ((run.y + 1) % size_.y == 0) AddRow(run.y / size_.y + 1, run);
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
    for (int32_t bx = run.begin / size_.x; bx <= run.end / size_.x; ++bx) {
      const auto bit = static_cast<size_t>(bx - first_x_);
      row[bit / 64] |= uint64_t{1} << bit % 64;
    }
  }

  uint64_t CountRow(std::span<const uint64_t> row) const {
    uint64_t blocks = 0, first = row.size() * 64, last = 0;
    for (size_t n = 0; n < row.size(); ++n) {
      if (row[n] == 0) continue;
      blocks += static_cast<uint64_t>(std::popcount(row[n]));
      first = std::min<uint64_t>(first, 64 * n + static_cast<uint64_t>(std::countr_zero(row[n])));
      last = 64 * n + 63 - static_cast<uint64_t>(std::countl_zero(row[n]));
    }
    return cavities_ == CavityFilling::kOn && blocks > 0 ? last - first + 1 : blocks;
  }

  BlockSize size_;
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
  const uint64_t voxels_per_brick =
      declared.points == VoxelPoints::kTwo ? kVoxelsPerBrick : kRefinedVoxelsPerBrick;
  const uint64_t bricks =
      SaturatingAdd(at_work / voxels_per_brick, kLeastBricks * static_cast<uint64_t>(threads));
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

uint64_t MostBricksOf(const LabeledObject& object, VoxelPoints points, CavityFilling cavities) {
  if (object.runs.empty()) return 0;
  const BlockSize size = BlockSizeOf(points);
  BlockLayer here(object.box, size, cavities), above(object.box, size, cavities);
  uint64_t blocks = 0;
  int32_t bz = object.runs.front().z / size.z;
  for (const VoxelRun& run : object.runs) {
    while (bz < run.z / size.z) {
      blocks += here.TakeCount();
      std::swap(here, above);
      ++bz;
    }
    here.Add(run);
    if ((run.z + 1) % size.z == 0) above.Add(run);
  }
  return 2 * (blocks + here.TakeCount() + above.TakeCount());
}

uint64_t BytesToComputeLabel(uint64_t bricks) {
  return SaturatingAdd(SaturatingMultiply(bricks, kPipelineBytesPerBrick), kFixedBytesPerLabel);
}

uint64_t BytesOf(const LabeledObject& object) {
  return kBytesPerLabel + object.runs.capacity() * sizeof(VoxelRun);
}

}  // namespace bccskel::server
