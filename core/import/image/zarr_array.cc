// .zarray of Zarr 2, and what both versions share.
#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"
#include "core/import/image/json_metadata.h"
#include "core/import/image/zarr_metadata.h"

namespace bccskel {
namespace {

using Json = nlohmann::json;

// "<u2": byte order, kind, bytes.
absl::Status ReadType(const Json& dtype, ZarrArray& array) {
  if (!dtype.is_string()) {
    return absl::UnimplementedError("dtype is not one number: records are not supported");
  }
  const auto name = dtype.get<std::string>();
  const std::optional<NumpyType> type = NumpyTypeOf(name);
  if (!type.has_value()) {
    return BadField("dtype", name,
                    "is not a type that is read: bool, integers, float16, float32, float64");
  }
  array.type = type->type;
  array.halves = type->halves;
  array.byte_order = type->byte_order;
  return absl::OkStatus();
}

template <typename T>
absl::StatusOr<T> FillOf(const Json& value) {
  if (value.is_null()) return T{0};
  if (value.is_boolean()) return static_cast<T>(value.get<bool>());
  if constexpr (std::is_floating_point_v<T>) {
    if (value == "NaN") return std::numeric_limits<T>::quiet_NaN();
    if (value == "Infinity") return std::numeric_limits<T>::infinity();
    if (value == "-Infinity") return -std::numeric_limits<T>::infinity();
    if (value.is_number()) return value.get<T>();
  } else {
    const bool fits = value.is_number_unsigned()
                          ? std::in_range<T>(value.get<uint64_t>())
                          : value.is_number_integer() && std::in_range<T>(value.get<int64_t>());
    if (fits) return value.get<T>();
    // Some writers put a dot behind whole numbers.
    if (value.is_number_float() && value.get<double>() == 0) return T{0};
  }
  return BadValue("fill_value", value, "is not a value of the array's type");
}

// The bits of a float as Zarr 3 may write them: "0x7fc00000".
std::optional<uint64_t> BitsOf(const Json& value, size_t bytes) {
  if (!value.is_string()) return std::nullopt;
  const auto text = value.get<std::string>();
  uint64_t bits = 0;
  const bool is_hex = text.starts_with("0x") && text.size() == 2 + 2 * bytes;
  return is_hex && absl::SimpleHexAtoi(text, &bits) ? std::optional(bits) : std::nullopt;
}

absl::StatusOr<ChunkCodec> CodecOf(const Json& compressor) {
  if (compressor.is_null()) return ChunkCodec::kNone;
  BCCSKEL_ASSIGN_OR_RETURN(const std::string id,
                           TextOf("the compressor's id", MemberOf(compressor, "id")));
  return ZarrCodecOf(id);
}

}  // namespace

absl::StatusOr<ChunkCodec> ZarrCodecOf(std::string_view name) {
  if (name == "blosc") return ChunkCodec::kBlosc;
  if (name == "zstd") return ChunkCodec::kZstd;
  if (name == "gzip" || name == "zlib") return ChunkCodec::kDeflate;
  if (name == "lz4") return ChunkCodec::kLz4;
  return absl::UnimplementedError(
      BadField("compressor", name, "is not supported; blosc, zstd, gzip, zlib and lz4 are")
          .message());
}

absl::Status ReadZarrFill(const Json& value, ZarrArray& array) {
  absl::Status read = WithVoxelType(array.type, [&]<typename T>(T) -> absl::Status {
    if (std::is_floating_point_v<T> || array.halves == StoredHalves::kYes) {
      if (const auto bits = BitsOf(value, sizeof(T)); bits.has_value()) {
        for (size_t n = 0; n < sizeof(T); ++n) {
          const bool low_first = std::endian::native == std::endian::little;
          array.fill[low_first ? n : sizeof(T) - 1 - n] = static_cast<std::byte>(*bits >> 8 * n);
        }
        return absl::OkStatus();
      }
    }
    T fill = 0;
    if (array.halves == StoredHalves::kYes) {
      BCCSKEL_ASSIGN_OR_RETURN(const float number, FillOf<float>(value));
      fill = static_cast<T>(NearestHalf(number));
    } else {
      BCCSKEL_ASSIGN_OR_RETURN(fill, FillOf<T>(value));
    }
    std::memcpy(array.fill.data(), &fill, sizeof(T));
    return absl::OkStatus();
  });
  if (read.ok() && array.byte_order != std::endian::native) {
    std::reverse(array.fill.data(), array.fill.data() + VoxelBytes(array.type));
  }
  return read;
}

absl::Status CheckZarrChunks(const ZarrArray& array, const ImageLimits& limits) {
  constexpr size_t kMostAxes = 8;
  if (array.shape.empty() || array.shape.size() > kMostAxes) {
    return absl::InvalidArgumentError(absl::StrFormat("the array has %d axes, it must have 1 to %d",
                                                      array.shape.size(), kMostAxes));
  }
  if (array.chunks.size() != array.shape.size()) {
    return absl::InvalidArgumentError(absl::StrFormat("the array has %d axes, its chunks have %d",
                                                      array.shape.size(), array.chunks.size()));
  }
  uint64_t room = limits.max_chunk_bytes / VoxelBytes(array.type);
  for (const int64_t length : array.chunks) {
    if (length < 1) {
      return absl::InvalidArgumentError(
          absl::StrFormat("chunks are %d long, they must be at least 1", length));
    }
    room /= static_cast<uint64_t>(length);
  }
  if (room > 0) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrFormat(
      "a chunk holds more than %d bytes, the limit: write smaller chunks", limits.max_chunk_bytes));
}

uint64_t ZarrArray::ChunkBytes() const {
  uint64_t bytes = VoxelBytes(type);
  for (const int64_t length : chunks) bytes *= static_cast<uint64_t>(length);
  return bytes;
}

absl::StatusOr<ZarrArray> ParseZarrArray(const Json& metadata, const ImageLimits& limits) {
  const Json& version = MemberOf(metadata, "zarr_format");
  if (version == 3) return ParseZarr3Array(metadata, limits);
  if (version != 2) return BadValue("zarr_format", version, "is neither 2 nor 3");
  ZarrArray array;
  BCCSKEL_ASSIGN_OR_RETURN(array.shape, IntegersOf("shape", MemberOf(metadata, "shape")));
  BCCSKEL_ASSIGN_OR_RETURN(array.chunks, IntegersOf("chunks", MemberOf(metadata, "chunks")));
  BCCSKEL_RETURN_IF_ERROR(ReadType(MemberOf(metadata, "dtype"), array));
  BCCSKEL_RETURN_IF_ERROR(CheckZarrChunks(array, limits));
  BCCSKEL_RETURN_IF_ERROR(ReadZarrFill(MemberOf(metadata, "fill_value"), array));
  BCCSKEL_ASSIGN_OR_RETURN(array.codec, CodecOf(MemberOf(metadata, "compressor")));
  const Json& filters = MemberOf(metadata, "filters");
  if (!filters.is_null() && !(filters.is_array() && filters.empty())) {
    return absl::UnimplementedError(BadValue("filters", filters, "are not supported").message());
  }
  const Json& order = MemberOf(metadata, "order");
  if (order != "C" && order != "F") return BadValue("order", order, "is neither C nor F");
  array.order.resize(array.shape.size());
  std::iota(array.order.begin(), array.order.end(), size_t{0});
  if (order == "F") std::reverse(array.order.begin(), array.order.end());
  const Json& separator = MemberOf(metadata, "dimension_separator");
  if (!separator.is_null() && separator != "." && separator != "/") {
    return BadValue("dimension_separator", separator, "is neither . nor /");
  }
  array.separator = separator == "/" ? '/' : '.';
  return array;
}

}  // namespace bccskel
