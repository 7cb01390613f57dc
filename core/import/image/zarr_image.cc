#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "core/exec/uninitialized.h"
#include "core/import/image/chunked_image.h"
#include "core/import/image/image_choice.h"
#include "core/import/image/image_readers.h"
#include "core/import/image/json_metadata.h"
#include "core/import/image/zarr_metadata.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

bool Holds(const std::string& folder, const char* name) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::path(folder) / name, ignored);
}

// What each axis of the array is to the image.
struct ZarrAxes {
  std::array<std::optional<size_t>, 3> space;  // which axis x, y and z are
  std::vector<int64_t> place;                  // the chosen place along each axis; 0 of space
};

absl::StatusOr<ZarrAxes> AxesOf(const std::vector<char>& names, const ZarrArray& array,
                                const ImageOptions& options) {
  ZarrAxes axes;
  axes.place.assign(names.size(), 0);
  for (size_t n = 0; n < names.size(); ++n) {
    if (names[n] == 't' || names[n] == 'c') {
      if (array.shape[n] < 1) break;  // SizeOf() refuses it
      const char letter = names[n] == 't' ? 'T' : 'C';
      BCCSKEL_ASSIGN_OR_RETURN(axes.place[n], ChosenAlong(letter, array.shape[n], options));
    } else {
      axes.space[static_cast<size_t>(names[n] - 'x')] = n;
    }
  }
  const auto none_of = [&names](char name) { return std::ranges::count(names, name) == 0; };
  if ((options.channel.value_or(0) != 0 && none_of('c')) ||
      (options.time.value_or(0) != 0 && none_of('t'))) {
    return absl::InvalidArgumentError(
        "--channel and --time apply to the axes c and t, and the image has no such axis");
  }
  if (axes.space[0].has_value() && axes.space[1].has_value()) return axes;
  return absl::InvalidArgumentError("the image has no axes y and x");
}

std::vector<char> AxesOfPlainArray(size_t count) {
  constexpr std::string_view kNames = "tczyx";
  const std::string_view last = kNames.substr(kNames.size() - count);
  return {last.begin(), last.end()};
}

absl::StatusOr<ImageSize> SizeOf(const ZarrArray& array, const ZarrAxes& axes,
                                 const ImageLimits& limits) {
  if (std::ranges::any_of(array.shape, [](int64_t length) { return length < 1; })) {
    return absl::InvalidArgumentError("an axis of the array holds no voxels");
  }
  std::vector<int64_t> lengths;
  for (const std::optional<size_t>& axis : axes.space) {
    lengths.push_back(axis.has_value() ? array.shape[*axis] : 1);
  }
  return SizeOfAxes(lengths, limits);
}

absl::StatusOr<Placement> PlacementOf(const ZarrLevel& level, const ZarrAxes& axes) {
  std::array<double, 3> spacing = {1, 1, 1};
  WorldPoint origin = {0, 0, 0};
  for (size_t n = 0; n < 3 && !level.scale.empty(); ++n) {
    if (!axes.space[n].has_value()) continue;
    spacing[n] = level.scale[*axes.space[n]];
    origin[n] = level.translation[*axes.space[n]];
  }
  return PlacementOfSpacing(spacing, origin);
}

// Where the chunks of a shard lie in its file.
struct ShardPlace {
  uint64_t offset = 0;
  uint64_t length = 0;
};

absl::StatusOr<std::vector<ShardPlace>> ReadShardIndex(const ImageFile& file,
                                                       const ZarrShards& shards) {
  uint64_t places = 1;
  for (const int64_t along : shards.chunks) places *= static_cast<uint64_t>(along);
  const uint64_t length = places * sizeof(ShardPlace) + (shards.has_checksum ? 4 : 0);
  if (length > file.size()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the file has %d bytes, its index alone takes %d", file.size(), length));
  }
  BCCSKEL_ASSIGN_OR_RETURN(
      const std::string bytes,
      ReadStored(file, shards.index_first ? 0 : file.size() - length, length, shards.has_checksum));
  std::vector<ShardPlace> index(bytes.size() / sizeof(ShardPlace));
  std::memcpy(index.data(), bytes.data(), index.size() * sizeof(ShardPlace));
  if constexpr (std::endian::native == std::endian::big) {
    for (ShardPlace& place : index) {
      place = {__builtin_bswap64(place.offset), __builtin_bswap64(place.length)};
    }
  }
  return index;
}

// Chunks are files or parts of files; one at the end of the array is as large as the others.
class ZarrStore : public ChunkStore {
 public:
  ZarrStore(std::string folder, ZarrArray array, ZarrAxes axes)
      : folder_(std::move(folder)), array_(std::move(array)), axes_(std::move(axes)) {}

  absl::StatusOr<std::optional<ChunkVoxels>> Read(const ChunkIndex& chunk) override {
    std::vector<int64_t> index(array_.shape.size());
    for (size_t n = 0; n < index.size(); ++n) index[n] = axes_.place[n] / array_.chunks[n];
    for (size_t n = 0; n < 3; ++n) {
      if (axes_.space[n].has_value()) index[*axes_.space[n]] = chunk[n];
    }
    size_t in_shard = 0;  // the last axis varies fastest
    for (size_t n = 0; array_.shards.has_value() && n < index.size(); ++n) {
      const int64_t along = array_.shards->chunks[n];
      in_shard = in_shard * static_cast<size_t>(along) + static_cast<size_t>(index[n] % along);
      index[n] /= along;
    }
    const std::string name = NameOf(index);
    auto file = ImageFile::Open(folder_ + "/" + name);
    if (absl::IsNotFound(file.status())) return std::nullopt;
    BCCSKEL_RETURN_IF_ERROR(file.status());
    const absl::StatusOr<bool> expanded = Expand(name, *std::move(file), in_shard);
    if (!expanded.ok()) {
      return absl::Status(expanded.status().code(),
                          absl::StrFormat("chunk '%s': %s", name, expanded.status().message()));
    }
    return *expanded ? std::optional(Voxels()) : std::nullopt;
  }

 private:
  static constexpr uint64_t kMissing = std::numeric_limits<uint64_t>::max();

  std::string NameOf(const std::vector<int64_t>& index) const {
    return array_.key_prefix + absl::StrJoin(index, std::string(1, array_.separator));
  }

  // Fills bytes_, unless the shard lacks the chunk.
  absl::StatusOr<bool> Expand(const std::string& name, std::shared_ptr<const ImageFile> file,
                              size_t in_shard) {
    ShardPlace place = {.offset = 0, .length = file->size()};
    if (array_.shards.has_value()) {
      BCCSKEL_ASSIGN_OR_RETURN(place, PlaceInShard(name, *file, in_shard));
      if (place.offset == kMissing && place.length == kMissing) return false;
    }
    if (array_.shards.has_value() || array_.has_checksum) {
      BCCSKEL_ASSIGN_OR_RETURN(std::string stored,
                               ReadStored(*file, place.offset, place.length, array_.has_checksum));
      file = ImageFile::OfBytes(name, std::move(stored));
    }
    bytes_.resize(static_cast<size_t>(array_.ChunkBytes()));
    BCCSKEL_RETURN_IF_ERROR(ExpandChunk(array_.codec, file, bytes_));
    return true;
  }

  // A slab visits each shard for every row of chunks in it, so indices are kept.
  absl::StatusOr<ShardPlace> PlaceInShard(const std::string& name, const ImageFile& file,
                                          size_t in_shard) {
    constexpr size_t kMostPlaces = size_t{1} << 22;  // 64 MiB
    auto known = indices_.find(name);
    if (known == indices_.end()) {
      BCCSKEL_ASSIGN_OR_RETURN(std::vector<ShardPlace> index, ReadShardIndex(file, *array_.shards));
      if (indices_.size() * index.size() > kMostPlaces) indices_.clear();
      known = indices_.emplace(name, std::move(index)).first;
    }
    return known->second[in_shard];
  }

  ChunkVoxels Voxels() const {
    const size_t count = array_.shape.size();
    std::vector<size_t> step(count);
    size_t bytes = VoxelBytes(array_.type);
    for (size_t n = 0; n < count; ++n) {
      const size_t axis = array_.order[count - 1 - n];
      step[axis] = bytes;
      bytes *= static_cast<size_t>(array_.chunks[axis]);
    }
    ChunkVoxels voxels = {.first = bytes_.data(), .step = {0, 0, 0}};
    for (size_t n = 0; n < count; ++n) {
      voxels.first += static_cast<size_t>(axes_.place[n] % array_.chunks[n]) * step[n];
    }
    for (size_t n = 0; n < 3; ++n) {
      if (axes_.space[n].has_value()) voxels.step[n] = step[*axes_.space[n]];
    }
    return voxels;
  }

  std::string folder_;
  ZarrArray array_;
  ZarrAxes axes_;
  exec::UninitializedVector<std::byte> bytes_;
  std::unordered_map<std::string, std::vector<ShardPlace>> indices_;  // by the name of the shard
};

absl::StatusOr<std::unique_ptr<ImageSource>> OpenArray(const std::string& folder,
                                                       const Json& metadata, ZarrLevel level,
                                                       const ImageOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(ZarrArray array, ParseZarrArray(metadata, options.limits));
  const size_t count = array.shape.size();
  if (level.axes.empty()) level.axes = array.axes;
  if (level.axes.empty() && count <= 5) level.axes = AxesOfPlainArray(count);
  if (level.axes.size() != count) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the array has %d axes, %d are named or can be", count, level.axes.size()));
  }
  BCCSKEL_ASSIGN_OR_RETURN(ZarrAxes axes, AxesOf(level.axes, array, options));
  ChunkedImage image;
  image.info.format = level.path.empty() ? "Zarr" : "OME-Zarr";
  image.stored_type = array.type;
  image.halves = array.halves;
  image.info.unit = level.unit;
  image.byte_order = array.byte_order;
  image.fill = array.fill;
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOf(array, axes, options.limits));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.placement, PlacementOf(level, axes));
  for (size_t n = 0; n < 3; ++n) {
    if (axes.space[n].has_value()) image.chunk_size[n] = array.chunks[*axes.space[n]];
  }
  return OpenChunkedImage(std::move(image),
                          std::make_unique<ZarrStore>(folder, std::move(array), std::move(axes)),
                          options.limits);
}

// The metadata of a folder; null is what it has none of.
struct ZarrNode {   // NOLINT(bugprone-exception-escape): moving JSON does not throw
  Json array;       // of either version
  Json attributes;  // of a group; those of OME
};

// Programs that convert a folder may leave the metadata of Zarr 2 beside those of Zarr 3, which
// then count.
absl::StatusOr<ZarrNode> ReadNode(const std::string& folder, const ImageLimits& limits) {
  ZarrNode node;
  BCCSKEL_ASSIGN_OR_RETURN(auto metadata, ReadJson(folder + "/zarr.json", limits));
  if (!metadata.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(metadata, ReadJson(folder + "/.zarray", limits));
    if (metadata.has_value()) {
      node.array = *std::move(metadata);
      return node;
    }
    BCCSKEL_ASSIGN_OR_RETURN(metadata, ReadJson(folder + "/.zattrs", limits));
    if (metadata.has_value()) node.attributes = *std::move(metadata);
    return node;
  }
  const Json& type = MemberOf(*metadata, "node_type");
  if (type == "array") {
    node.array = *std::move(metadata);
  } else if (type == "group") {
    node.attributes = MemberOf(MemberOf(*metadata, "attributes"), "ome");
  } else {
    return BadValue("node_type", type, "is neither array nor group");
  }
  return node;
}

// An array may be a level of the group above, as OME.zarr/0 is: then that says where it lies.
absl::StatusOr<ZarrLevel> LevelOfGroupAbove(const std::string& folder, ImageOptions options) {
  std::error_code ignored;
  auto path = std::filesystem::absolute(folder, ignored).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const auto above = ReadNode(path.parent_path().string(), options.limits);
  if (!above.ok()) return ZarrLevel{};
  const Json& images = MemberOf(above->attributes, "multiscales");
  if (!images.is_array() || images.empty()) return ZarrLevel{};
  const Json& datasets = MemberOf(images[0], "datasets");
  for (size_t n = 0; datasets.is_array() && n < datasets.size(); ++n) {
    if (MemberOf(datasets[n], "path") != path.filename().string()) continue;
    options.level = static_cast<int64_t>(n);
    return ParseMultiscales(above->attributes, options);
  }
  return ZarrLevel{};
}

}  // namespace

bool IsZarrFolder(const std::string& folder) {
  return Holds(folder, ".zarray") || Holds(folder, ".zattrs") || Holds(folder, ".zgroup") ||
         Holds(folder, "zarr.json");
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenZarr(const std::string& folder,
                                                      const ImageOptions& options) {
  BCCSKEL_ASSIGN_OR_RETURN(const ZarrNode node, ReadNode(folder, options.limits));
  if (!node.array.is_null()) {
    BCCSKEL_RETURN_IF_ERROR(ChosenLevel(1, options).status());
    BCCSKEL_ASSIGN_OR_RETURN(ZarrLevel level, LevelOfGroupAbove(folder, options));
    return OpenArray(folder, node.array, std::move(level), options);
  }
  BCCSKEL_ASSIGN_OR_RETURN(ZarrLevel level, ParseMultiscales(node.attributes, options));
  const std::string path = folder + "/" + level.path;
  BCCSKEL_ASSIGN_OR_RETURN(const ZarrNode chosen, ReadNode(path, options.limits));
  if (!chosen.array.is_null()) return OpenArray(path, chosen.array, std::move(level), options);
  return absl::InvalidArgumentError(absl::StrFormat(
      "the group names the array '%s', which has neither .zarray nor zarr.json", level.path));
}

}  // namespace bccskel
