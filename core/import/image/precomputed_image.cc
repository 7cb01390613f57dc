#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/uninitialized.h"
#include "core/import/image/byte_stream.h"
#include "core/import/image/chunk_codec.h"
#include "core/import/image/chunked_image.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_choice.h"
#include "core/import/image/image_readers.h"
#include "core/import/image/json_metadata.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

constexpr const char* kInfo = "/info";

// One level, x, y, z.
struct Scale {
  std::string key;  // its folder
  ChunkIndex size, offset, chunk;
  std::array<double, 3> resolution;  // nm
  std::optional<ChunkIndex> block;   // of compressed segmentation; nothing: raw
};

template <typename Number>
absl::StatusOr<std::array<Number, 3>> Triple(std::string_view what,
                                             const absl::StatusOr<std::vector<Number>>& list) {
  BCCSKEL_RETURN_IF_ERROR(list.status());
  if (list->size() == 3) return std::array<Number, 3>{(*list)[0], (*list)[1], (*list)[2]};
  return absl::InvalidArgumentError(
      absl::StrFormat("%s has %d numbers, it must have 3", std::string(what), list->size()));
}

absl::StatusOr<ChunkIndex> Integers(const char* what, const Json& value) {
  return Triple<int64_t>(what, IntegersOf(what, value));
}

// Positive, and in all below a limit.
absl::Status CheckBox(const char* what, const ChunkIndex& box, uint64_t most) {
  uint64_t room = most;
  for (const int64_t length : box) {
    if (length < 1) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%s is %d along one axis, it must be at least 1", what, length));
    }
    room /= static_cast<uint64_t>(length);
  }
  if (room > 0) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrFormat(
      "%s of %d x %d x %d is over the limit of %d voxels", what, box[0], box[1], box[2], most));
}

absl::Status ReadEncoding(const Json& level, Scale& scale) {
  const Json& encoding = MemberOf(level, "encoding");
  if (encoding == "raw") return absl::OkStatus();
  if (encoding != "compressed_segmentation") {
    return absl::UnimplementedError(
        BadValue("encoding", encoding, "is not supported; raw and compressed_segmentation are")
            .message());
  }
  constexpr const char* kBlock = "compressed_segmentation_block_size";
  BCCSKEL_ASSIGN_OR_RETURN(scale.block, Integers(kBlock, MemberOf(level, kBlock)));
  return CheckBox(kBlock, *scale.block, uint64_t{1} << 24);
}

absl::StatusOr<Scale> ReadScale(const Json& level, uint64_t max_chunk_voxels) {
  if (!MemberOf(level, "sharding").is_null()) {
    return absl::UnimplementedError(
        "the level is sharded, which is not supported; write it unsharded");
  }
  Scale scale;
  BCCSKEL_ASSIGN_OR_RETURN(scale.key, TextOf("key", MemberOf(level, "key")));
  if (!IsBelowFolder(scale.key)) {
    return BadField("key", scale.key, "is not that of a folder in this one");
  }
  BCCSKEL_ASSIGN_OR_RETURN(scale.size, Integers("size", MemberOf(level, "size")));
  const Json& offset = MemberOf(level, "voxel_offset");
  scale.offset = {0, 0, 0};
  if (!offset.is_null()) {
    BCCSKEL_ASSIGN_OR_RETURN(scale.offset, Integers("voxel_offset", offset));
  }
  constexpr int64_t kFarthest = int64_t{1} << 48;
  for (const int64_t along : scale.offset) {
    if (along <= -kFarthest || along >= kFarthest) {
      return BadValue("voxel_offset", offset, "is too far from 0");
    }
  }
  const Json& chunks = MemberOf(level, "chunk_sizes");
  if (!chunks.is_array() || chunks.empty()) {
    return BadValue("chunk_sizes", chunks, "is not a list of sizes");
  }
  BCCSKEL_ASSIGN_OR_RETURN(scale.chunk, Integers("chunk_sizes", chunks[0]));
  BCCSKEL_RETURN_IF_ERROR(CheckBox("chunk_sizes", scale.chunk, max_chunk_voxels));
  constexpr const char* kResolution = "resolution";
  BCCSKEL_ASSIGN_OR_RETURN(
      scale.resolution,
      Triple<double>(kResolution, NumbersOf(kResolution, MemberOf(level, kResolution))));
  BCCSKEL_RETURN_IF_ERROR(ReadEncoding(level, scale));
  return scale;
}

absl::StatusOr<Scale> ChosenScale(const Json& scales, uint64_t max_chunk_voxels,
                                  const ImageOptions& options) {
  if (!scales.is_array() || scales.empty()) {
    return BadValue("scales", scales, "is not a list of levels");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const int64_t level,
                           ChosenLevel(static_cast<int64_t>(scales.size()), options));
  return ReadScale(scales[static_cast<size_t>(level)], max_chunk_voxels);
}

// A chunk ends with the image, unlike Zarr's.
class PrecomputedStore : public ChunkStore {
 public:
  PrecomputedStore(std::string folder, Scale scale, size_t voxel_bytes)
      : folder_(std::move(folder)), scale_(std::move(scale)), voxel_bytes_(voxel_bytes) {}

  absl::StatusOr<std::optional<ChunkVoxels>> Read(const ChunkIndex& chunk) override {
    ChunkIndex size;
    std::string name;
    for (size_t n = 0; n < 3; ++n) {
      const int64_t begin = chunk[n] * scale_.chunk[n];
      size[n] = std::min(scale_.chunk[n], scale_.size[n] - begin);
      absl::StrAppendFormat(&name, "%s%d-%d", n == 0 ? "" : "_", scale_.offset[n] + begin,
                            scale_.offset[n] + begin + size[n]);
    }
    const std::string path = folder_ + "/" + scale_.key + "/" + name;
    auto file = ImageFile::Open(path);
    if (absl::IsNotFound(file.status())) file = ImageFile::Open(path + ".gz");
    if (absl::IsNotFound(file.status())) return std::nullopt;
    BCCSKEL_RETURN_IF_ERROR(file.status());
    const absl::Status expanded = Expand(*std::move(file), size);
    if (!expanded.ok()) {
      return absl::Status(expanded.code(),
                          absl::StrFormat("chunk '%s': %s", name, expanded.message()));
    }
    const auto row = static_cast<size_t>(size[0]) * voxel_bytes_;
    return ChunkVoxels{.first = bytes_.data(),
                       .step = {voxel_bytes_, row, row * static_cast<size_t>(size[1])}};
  }

 private:
  absl::Status Expand(std::shared_ptr<const ImageFile> file, const ChunkIndex& size) {
    const auto voxels = static_cast<size_t>(size[0] * size[1] * size[2]);
    bytes_.resize(voxels * voxel_bytes_);
    std::array<std::byte, 2> magic = {};
    BCCSKEL_RETURN_IF_ERROR(file->ReadAt(0, magic).status());
    const bool gzip = SniffGzip(magic) != Compression::kNone;
    if (!scale_.block.has_value()) {
      // Raw voxels may begin as gzip does; but they do not expand to a chunk.
      const bool expands = gzip && ExpandChunk(ChunkCodec::kDeflate, file, bytes_).ok();
      if (expands) return absl::OkStatus();
      const bool raw = !gzip || file->size() == bytes_.size();
      return ExpandChunk(raw ? ChunkCodec::kNone : ChunkCodec::kDeflate, file, bytes_);
    }
    BCCSKEL_RETURN_IF_ERROR(ReadPacked(std::move(file), gzip));
    return ExpandCompressedSegmentation(packed_, size, *scale_.block, voxel_bytes_, bytes_);
  }

  // The expanded file; it has to be no longer than a chunk that compresses badly.
  absl::Status ReadPacked(std::shared_ptr<const ImageFile> file, bool gzip) {
    const auto block_voxels =
        static_cast<size_t>((*scale_.block)[0] * (*scale_.block)[1] * (*scale_.block)[2]);
    const size_t most = 4 * bytes_.size() + 4 * block_voxels * voxel_bytes_ + 65536;
    const uint64_t can_hold = gzip ? file->size() * kMaxDeflateRatio : file->size();
    packed_.resize(static_cast<size_t>(std::min<uint64_t>(most + 1, can_hold)));
    BCCSKEL_ASSIGN_OR_RETURN(
        auto stream,
        ByteStream::Open(std::move(file), 0, gzip ? Compression::kDeflate : Compression::kNone));
    BCCSKEL_ASSIGN_OR_RETURN(const size_t got, stream->Read(packed_));
    packed_.resize(got);
    if (got <= most) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrFormat(
        "it has more than %d bytes, too many for a chunk of %d", most, bytes_.size()));
  }

  std::string folder_;
  Scale scale_;
  size_t voxel_bytes_;
  exec::UninitializedVector<std::byte> packed_;
  exec::UninitializedVector<std::byte> bytes_;
};

absl::StatusOr<Placement> PlacementOf(const Scale& scale) {
  // Voxel n covers the places from n to n + 1 times the resolution.
  WorldPoint origin;
  for (size_t n = 0; n < 3; ++n) {
    origin[n] = (static_cast<double>(scale.offset[n]) + 0.5) * scale.resolution[n];
  }
  return PlacementOfSpacing(scale.resolution, origin);
}

}  // namespace

bool IsPrecomputedFolder(const std::string& folder) {
  std::error_code ignored;
  return std::filesystem::exists(folder + kInfo, ignored);
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenPrecomputed(const std::string& folder,
                                                             const ImageOptions& options) {
  if (options.channel.has_value() || options.time.has_value()) {
    return absl::InvalidArgumentError("--channel and --time apply only to TIFF and OME-Zarr");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const auto info, ReadJson(folder + kInfo, options.limits));
  if (!info.has_value()) return absl::NotFoundError("the file info is gone");
  const Json& kind = MemberOf(*info, "@type");
  if (!kind.is_null() && kind != "neuroglancer_multiscale_volume") {
    return BadValue("@type", kind, "is not that of a volume");
  }
  const Json& channels = MemberOf(*info, "num_channels");
  if (channels != 1) {
    return absl::UnimplementedError(
        BadValue("num_channels", channels, "is not 1; only one channel is read").message());
  }
  constexpr const char* kType = "data_type";
  BCCSKEL_ASSIGN_OR_RETURN(const std::string name, TextOf(kType, MemberOf(*info, kType)));
  BCCSKEL_ASSIGN_OR_RETURN(const VoxelType type, ParseVoxelType(name));
  const size_t bytes = VoxelBytes(type);
  BCCSKEL_ASSIGN_OR_RETURN(
      Scale scale,
      ChosenScale(MemberOf(*info, "scales"), options.limits.max_chunk_bytes / bytes, options));
  if (scale.block.has_value() && type != VoxelType::kUint32 && type != VoxelType::kUint64) {
    return BadField(kType, name, "has no compressed segmentation; uint32 and uint64 have");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const ImageSize size, SizeOfAxes(scale.size, options.limits));
  BCCSKEL_ASSIGN_OR_RETURN(const Placement placement, PlacementOf(scale));
  ChunkedImage image = {.info = {.format = "precomputed",
                                 .size = size,
                                 .placement = placement,
                                 .unit = "nm",
                                 .world = ""},
                        .stored_type = type,
                        .chunk_size = scale.chunk};
  return OpenChunkedImage(std::move(image),
                          std::make_unique<PrecomputedStore>(folder, std::move(scale), bytes),
                          options.limits);
}

}  // namespace bccskel
