#include "core/labels/nrrd_writer.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <new>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

static_assert(std::endian::native == std::endian::little, "voxels are written as they lie");

absl::Status CheckImage(const MaskGrid& grid, const SparseImage& image) {
  const VoxelRun* before = nullptr;
  for (const auto& [run, value] : image) {
    const bool inside = run.z >= 0 && run.z < grid.nz && run.y >= 0 && run.y < grid.ny &&
                        run.begin >= 0 && run.begin < run.end && run.end <= grid.nx;
    const bool ordered = before == nullptr || *before < run;
    if (!inside || !ordered) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "run of voxels %d to %d at y %d, z %d is %s of %d x %d x %d voxels", run.begin, run.end,
          run.y, run.z, inside ? "out of order in the image" : "outside the image", grid.nx,
          grid.ny, grid.nz));
    }
    before = &run;
  }
  return absl::OkStatus();
}

// Viewers put an image without a named space into one of their own, mirrored if that is another.
std::string SpaceOf(const ImageWorld& world) {
  std::string space = "space dimension: 3\n";
  if (world.axes == "RAS") space = "space: right-anterior-superior\n";
  if (world.axes == "LPS") space = "space: left-posterior-superior\n";
  if (world.axes == "LAS") space = "space: left-anterior-superior\n";
  const std::string& unit = world.unit;
  if (unit.empty() || unit.find_first_of("\"\\\n") != unit.npos) return space;
  return space + absl::StrFormat("space units: \"%s\" \"%s\" \"%s\"\n", unit, unit, unit);
}

std::string HeaderOf(const MaskGrid& grid, const ImageWorld& world) {
  const Placement& p = grid.placement;
  std::string directions;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double size = p.spacing[axis];
    directions += absl::StrFormat(" (%.17g,%.17g,%.17g)", p.direction[axis] * size,
                                  p.direction[axis + 3] * size, p.direction[axis + 6] * size);
  }
  return absl::StrFormat(
      "NRRD0004\ntype: uint32\ndimension: 3\n%ssizes: %d %d %d\n"
      "space directions:%s\nspace origin: (%.17g,%.17g,%.17g)\nendian: little\n"
      "encoding: gzip\n\n",
      SpaceOf(world), grid.nx, grid.ny, grid.nz, directions, p.origin[0], p.origin[1], p.origin[2]);
}

// Appends a gzip stream to bytes.
class GzipStream {
 public:
  explicit GzipStream(std::string& bytes) : bytes_(bytes) {
    constexpr int kGzip = 15 + 16;  // the largest window, with gzip's header
    const int begun =
        deflateInit2(&stream_, Z_BEST_SPEED, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY);
    if (begun != Z_OK) throw std::bad_alloc();
  }
  ~GzipStream() { deflateEnd(&stream_); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  void Add(const std::vector<uint32_t>& values) {
    constexpr size_t kPiece = size_t{1} << 28;  // zlib counts in 32 bits
    for (size_t at = 0; at < values.size(); at += kPiece) {
      Deflate(values.data() + at, std::min(kPiece, values.size() - at), Z_NO_FLUSH);
    }
  }
  void Finish() { Deflate(nullptr, 0, Z_FINISH); }

 private:
  void Deflate(const uint32_t* values, size_t count, int flush) {
    // zlib does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<uint32_t*>(values));
    stream_.avail_in = static_cast<uInt>(count * sizeof(uint32_t));
    do {
      stream_.next_out = buffer_.data();
      stream_.avail_out = static_cast<uInt>(buffer_.size());
      deflate(&stream_, flush);
      bytes_.append(reinterpret_cast<const char*>(buffer_.data()),
                    buffer_.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

  std::string& bytes_;
  z_stream stream_ = {};
  std::vector<Bytef> buffer_ = std::vector<Bytef>(1 << 16);
};

}  // namespace

absl::StatusOr<std::string> NrrdBytes(const MaskGrid& grid, const ImageWorld& world,
                                      const SparseImage& image) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskGrid(grid));
  BCCSKEL_RETURN_IF_ERROR(CheckImage(grid, image));
  std::string bytes = HeaderOf(grid, world);
  GzipStream voxels(bytes);
  std::vector<uint32_t> slice(grid.VoxelsPerSlice());
  auto run = image.begin();
  for (int32_t z = 0; z < grid.nz; ++z) {
    std::ranges::fill(slice, 0u);
    for (; run != image.end() && run->voxels.z == z; ++run) {
      const auto row = slice.begin() + ptrdiff_t{run->voxels.y} * grid.nx;
      std::fill(row + run->voxels.begin, row + run->voxels.end, run->value);
    }
    voxels.Add(slice);
  }
  voxels.Finish();
  return bytes;
}

}  // namespace bccskel
