// Arrays in zarr.json of Zarr 3.
#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"
#include "core/import/image/json_metadata.h"
#include "core/import/image/zarr_metadata.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

absl::Status NotSupported(std::string_view what, const Json& value, std::string_view why) {
  return absl::UnimplementedError(BadValue(what, value, why).message());
}

// Codecs, grids and the like are objects, or a name alone.
absl::StatusOr<std::string> ExtensionName(std::string_view what, const Json& extension) {
  return TextOf(what, extension.is_object() ? MemberOf(extension, "name") : extension);
}
// numcodecs names the codecs that Zarr 3 does not define with its own name in front.
std::string_view WithoutRegistry(std::string_view name) {
  constexpr std::string_view kRegistry = "numcodecs.";
  return name.starts_with(kRegistry) ? name.substr(kRegistry.size()) : name;
}

const Json& OptionOf(const Json& extension, std::string_view option) {
  return MemberOf(MemberOf(extension, "configuration"), option);
}

// A member that Zarr 3 does not define may be ignored if it says so itself.
absl::Status CheckMembers(const Json& metadata) {
  constexpr std::array<std::string_view, 12> kKnown = {"zarr_format",     "node_type",
                                                       "shape",           "data_type",
                                                       "chunk_grid",      "chunk_key_encoding",
                                                       "fill_value",      "codecs",
                                                       "attributes",      "storage_transformers",
                                                       "dimension_names", "consolidated_metadata"};
  for (const auto& [name, value] : metadata.items()) {
    if (std::ranges::find(kKnown, name) != kKnown.end() || value.is_null()) continue;
    if (MemberOf(value, "must_understand") == false) continue;
    return NotSupported(name, value, "is an extension that is not supported");
  }
  const Json& transformers = MemberOf(metadata, "storage_transformers");
  if (transformers.is_null() || transformers.empty()) return absl::OkStatus();
  return NotSupported("storage_transformers", transformers, "are not supported");
}

absl::Status ReadZarr3Type(const Json& type, ZarrArray& array) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kTypes = {
      {{"bool", "|b1"},
       {"int8", "|i1"},
       {"int16", "<i2"},
       {"int32", "<i4"},
       {"int64", "<i8"},
       {"uint8", "|u1"},
       {"uint16", "<u2"},
       {"uint32", "<u4"},
       {"uint64", "<u8"},
       {"float16", "<f2"},
       {"float32", "<f4"},
       {"float64", "<f8"}}};
  BCCSKEL_ASSIGN_OR_RETURN(const std::string name, ExtensionName("data_type", type));
  for (const auto& [zarr, numpy] : kTypes) {
    if (name != zarr) continue;
    const std::optional<NumpyType> known = NumpyTypeOf(numpy);
    array.type = known->type;
    array.halves = known->halves;
    return absl::OkStatus();
  }
  return NotSupported("data_type", type, "is not read; bool, integers, float16 to float64 are");
}

absl::Status ReadChunks(const Json& grid, const ImageLimits& limits, ZarrArray& array) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string name, ExtensionName("chunk_grid", grid));
  if (name != "regular") return NotSupported("chunk_grid", grid, "is not regular");
  BCCSKEL_ASSIGN_OR_RETURN(array.chunks, IntegersOf("chunk_shape", OptionOf(grid, "chunk_shape")));
  ZarrArray small = array;  // chunks that are shards may be of any size
  for (int64_t& length : small.chunks) length = std::min<int64_t>(length, 1);
  return CheckZarrChunks(small, limits);
}

absl::Status ReadKeys(const Json& encoding, ZarrArray& array) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string name, ExtensionName("chunk_key_encoding", encoding));
  if (name != "default" && name != "v2") {
    return NotSupported("chunk_key_encoding", encoding, "is neither default nor v2");
  }
  const Json& separator = OptionOf(encoding, "separator");
  if (!separator.is_null() && separator != "." && separator != "/") {
    return BadValue("separator", separator, "is neither . nor /");
  }
  array.separator = (separator.is_null() ? name == "default" : separator == "/") ? '/' : '.';
  if (name == "default") array.key_prefix = std::string("c") + array.separator;
  return absl::OkStatus();
}

// What makes bytes of a chunk: maybe a transposition, then `bytes` or shards, then compressors.
class CodecReader {
 public:
  CodecReader(ZarrArray& array, const ImageLimits& limits) : array_(array), limits_(limits) {}

  absl::Status Read(const Json& codecs) {
    if (!codecs.is_array()) return BadValue("codecs", codecs, "is not a list");
    bool are_bytes = false;
    for (const Json& codec : codecs) {
      BCCSKEL_ASSIGN_OR_RETURN(const std::string name, ExtensionName("a codec's name", codec));
      const bool makes_bytes = name == "bytes" || name == "sharding_indexed";
      const bool transposes = name == "transpose";
      if ((makes_bytes || transposes) == are_bytes) {
        return BadValue("codecs", codecs, "are not in the order array, bytes, compression");
      }
      if (transposes) {
        BCCSKEL_RETURN_IF_ERROR(ReadOrder(OptionOf(codec, "order")));
      } else if (name == "sharding_indexed") {
        if (&codec != &codecs.back() || array_.shards.has_value() || !array_.order.empty()) {
          return NotSupported("codecs", codecs, "are not supported with sharding_indexed");
        }
        return ReadShards(codec);
      } else if (name == "bytes") {
        BCCSKEL_RETURN_IF_ERROR(ReadByteOrder(OptionOf(codec, "endian")));
        are_bytes = true;
      } else if (array_.has_checksum) {
        return NotSupported("codecs", codecs, "have one behind crc32c");
      } else if (name == "crc32c") {
        array_.has_checksum = true;
      } else if (array_.codec != ChunkCodec::kNone) {
        return NotSupported("codecs", codecs, "compress twice");
      } else {
        BCCSKEL_ASSIGN_OR_RETURN(array_.codec, ZarrCodecOf(WithoutRegistry(name)));
      }
    }
    if (are_bytes) return absl::OkStatus();
    return BadValue("codecs", codecs, "have neither bytes nor sharding_indexed");
  }

 private:
  absl::Status ReadOrder(const Json& order) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<int64_t> axes, IntegersOf("order", order));
    std::vector<int64_t> all(array_.shape.size());
    std::iota(all.begin(), all.end(), int64_t{0});
    if (!array_.order.empty() || !std::ranges::is_permutation(axes, all)) {
      return BadValue("order", order, "is not one order of the axes");
    }
    array_.order.assign(axes.begin(), axes.end());
    return absl::OkStatus();
  }

  absl::Status ReadByteOrder(const Json& endian) {
    if (!endian.is_null() && endian != "little" && endian != "big") {
      return BadValue("endian", endian, "is neither little nor big");
    }
    array_.byte_order = endian == "big" ? std::endian::big : std::endian::little;
    return absl::OkStatus();
  }

  absl::Status ReadShards(const Json& codec) {
    BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> chunks,
                             IntegersOf("chunk_shape", OptionOf(codec, "chunk_shape")));
    std::swap(chunks, array_.chunks);  // now of a shard, and of a chunk in it
    BCCSKEL_RETURN_IF_ERROR(CheckZarrChunks(array_, limits_));
    ZarrShards& shards = array_.shards.emplace();
    uint64_t room = limits_.max_chunks;
    for (size_t n = 0; n < chunks.size(); ++n) {
      if (chunks[n] % array_.chunks[n] != 0) {
        return absl::InvalidArgumentError(absl::StrFormat(
            "shards are %d long, no multiple of their chunks' %d", chunks[n], array_.chunks[n]));
      }
      shards.chunks.push_back(chunks[n] / array_.chunks[n]);
      room /= static_cast<uint64_t>(shards.chunks.back());
    }
    if (room == 0) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("a shard holds more than %d chunks, the limit: write smaller shards",
                          limits_.max_chunks));
    }
    const Json& location = OptionOf(codec, "index_location");
    if (!location.is_null() && location != "start" && location != "end") {
      return BadValue("index_location", location, "is neither start nor end");
    }
    shards.index_first = location == "start";
    BCCSKEL_RETURN_IF_ERROR(ReadIndex(OptionOf(codec, "index_codecs"), shards));
    return Read(OptionOf(codec, "codecs"));
  }

  // The index is read with the codecs that are usual, and not with others.
  static absl::Status ReadIndex(const Json& codecs, ZarrShards& shards) {
    if (!codecs.is_array()) return BadValue("index_codecs", codecs, "is not a list");
    std::vector<std::string> names;
    for (const Json& codec : codecs) {
      BCCSKEL_ASSIGN_OR_RETURN(names.emplace_back(), ExtensionName("an index codec's name", codec));
    }
    shards.has_checksum = names.size() == 2 && names[1] == "crc32c";
    if ((names.size() == 1 || shards.has_checksum) && names[0] == "bytes" &&
        OptionOf(codecs[0], "endian") != "big") {
      return absl::OkStatus();
    }
    return NotSupported("index_codecs", codecs, "are not supported; bytes and crc32c are");
  }

  ZarrArray& array_;
  const ImageLimits& limits_;
};

// Empty unless each axis has another name of those that are known.
std::vector<char> AxesNamedBy(const Json& names, size_t count) {
  std::vector<char> axes;
  if (!names.is_array() || names.size() != count) return {};
  for (const Json& name : names) {
    if (!name.is_string() || name.get<std::string>().size() != 1) return {};
    const auto axis = static_cast<char>(std::tolower(name.get<std::string>()[0]));
    const bool known = std::string_view("tczyx").find(axis) != std::string_view::npos;
    if (!known || std::ranges::count(axes, axis) > 0) return {};
    axes.push_back(axis);
  }
  return axes;
}

}  // namespace

absl::StatusOr<ZarrArray> ParseZarr3Array(const Json& metadata, const ImageLimits& limits) {
  ZarrArray array;
  BCCSKEL_RETURN_IF_ERROR(CheckMembers(metadata));
  BCCSKEL_ASSIGN_OR_RETURN(array.shape, IntegersOf("shape", MemberOf(metadata, "shape")));
  BCCSKEL_RETURN_IF_ERROR(ReadZarr3Type(MemberOf(metadata, "data_type"), array));
  BCCSKEL_RETURN_IF_ERROR(ReadChunks(MemberOf(metadata, "chunk_grid"), limits, array));
  BCCSKEL_RETURN_IF_ERROR(ReadKeys(MemberOf(metadata, "chunk_key_encoding"), array));
  BCCSKEL_RETURN_IF_ERROR(CodecReader(array, limits).Read(MemberOf(metadata, "codecs")));
  BCCSKEL_RETURN_IF_ERROR(CheckZarrChunks(array, limits));
  BCCSKEL_RETURN_IF_ERROR(ReadZarrFill(MemberOf(metadata, "fill_value"), array));
  if (array.order.empty()) {
    array.order.resize(array.shape.size());
    std::iota(array.order.begin(), array.order.end(), size_t{0});
  }
  array.axes = AxesNamedBy(MemberOf(metadata, "dimension_names"), array.shape.size());
  return array;
}

}  // namespace bccskel
