#include "core/import/image/chunk_codec.h"

#include <blosc.h>
#include <isa-l/crc.h>
#include <lz4.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/uninitialized.h"
#include "core/import/image/byte_stream.h"

namespace bccskel {
namespace {

absl::Status WrongLength(uint64_t got, uint64_t wanted) {
  return absl::InvalidArgumentError(
      absl::StrFormat("it expands to %d bytes, a chunk has %d", got, wanted));
}

absl::Status Damaged(const char* codec) {
  return absl::InvalidArgumentError(absl::StrFormat("its %s stream is damaged or cut", codec));
}

absl::Status ExpandStream(Compression compression, const std::shared_ptr<const ImageFile>& file,
                          std::span<std::byte> into) {
  BCCSKEL_ASSIGN_OR_RETURN(auto stream, ByteStream::Open(file, 0, compression));
  BCCSKEL_ASSIGN_OR_RETURN(const size_t got, stream->Read(into));
  if (got < into.size()) return WrongLength(got, into.size());
  std::array<std::byte, 1> more;
  BCCSKEL_ASSIGN_OR_RETURN(const size_t behind, stream->Read(more));
  if (behind == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("it expands to more than the %d bytes of a chunk", into.size()));
}

absl::Status ExpandZstd(std::span<const std::byte> packed, std::span<std::byte> into) {
  const size_t got = ZSTD_decompress(into.data(), into.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0) {
    return absl::InvalidArgumentError(
        absl::StrFormat("its zstd stream is damaged, cut or of another length than the %d bytes of "
                        "a chunk: %s",
                        into.size(), ZSTD_getErrorName(got)));
  }
  return got == into.size() ? absl::OkStatus() : WrongLength(got, into.size());
}

absl::Status ExpandLz4(std::span<const std::byte> packed, std::span<std::byte> into) {
  uint32_t declared = 0;  // little endian
  if (packed.size() < sizeof(declared)) return Damaged("lz4");
  std::memcpy(&declared, packed.data(), sizeof(declared));
  if constexpr (std::endian::native == std::endian::big) declared = __builtin_bswap32(declared);
  if (declared != into.size()) return WrongLength(declared, into.size());
  packed = packed.subspan(sizeof(declared));
  const int got = LZ4_decompress_safe(
      reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(into.data()),
      static_cast<int>(packed.size()), static_cast<int>(into.size()));
  if (got < 0) return Damaged("lz4");
  const auto filled = static_cast<size_t>(got);
  return filled == into.size() ? absl::OkStatus() : WrongLength(filled, into.size());
}

absl::Status ExpandBlosc(std::span<const std::byte> packed, std::span<std::byte> into) {
  size_t declared = 0;
  if (blosc_cbuffer_validate(packed.data(), packed.size(), &declared) != 0) return Damaged("blosc");
  if (declared != into.size()) return WrongLength(declared, into.size());
  const int got = blosc_decompress_ctx(packed.data(), into.data(), into.size(), 1);
  return got >= 0 && static_cast<size_t>(got) == into.size() ? absl::OkStatus() : Damaged("blosc");
}

}  // namespace

absl::Status ExpandChunk(ChunkCodec codec, const std::shared_ptr<const ImageFile>& file,
                         std::span<std::byte> into) {
  // No codec makes bytes that it cannot compress this much longer.
  const uint64_t most = 2 * uint64_t{into.size()} + 65536;
  if (file->size() > most || file->size() > std::numeric_limits<int32_t>::max()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("it has %d bytes, too many for a chunk of %d", file->size(), into.size()));
  }
  if (codec == ChunkCodec::kNone) return ExpandStream(Compression::kNone, file, into);
  if (codec == ChunkCodec::kDeflate) return ExpandStream(Compression::kDeflate, file, into);
  exec::UninitializedVector<std::byte> packed(static_cast<size_t>(file->size()));
  BCCSKEL_ASSIGN_OR_RETURN(const size_t got, file->ReadAt(0, packed));
  packed.resize(got);
  if (codec == ChunkCodec::kZstd) return ExpandZstd(packed, into);
  return codec == ChunkCodec::kLz4 ? ExpandLz4(packed, into) : ExpandBlosc(packed, into);
}

absl::StatusOr<std::string> ReadStored(const ImageFile& file, uint64_t offset, uint64_t length,
                                       bool has_checksum) {
  constexpr size_t kChecksumBytes = 4;
  const uint64_t most = std::numeric_limits<int32_t>::max();
  if (offset > file.size() || length > std::min(file.size() - offset, most) ||
      (has_checksum && length < kChecksumBytes)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%d bytes from byte %d on cannot be a part of the file's %d", length, offset, file.size()));
  }
  std::string bytes(static_cast<size_t>(length), '\0');
  BCCSKEL_ASSIGN_OR_RETURN(const size_t got,
                           file.ReadAt(offset, std::as_writable_bytes(std::span(bytes))));
  if (got < length) return absl::InvalidArgumentError("the file ends early");
  if (!has_checksum) return bytes;
  uint32_t stated = 0;  // little endian
  std::memcpy(&stated, bytes.data() + length - kChecksumBytes, kChecksumBytes);
  if constexpr (std::endian::native == std::endian::big) stated = __builtin_bswap32(stated);
  bytes.resize(bytes.size() - kChecksumBytes);
  const uint32_t sum = ~crc32_iscsi(reinterpret_cast<unsigned char*>(bytes.data()),
                                    static_cast<int>(bytes.size()), ~uint32_t{0});
  if (sum == stated) return bytes;
  return absl::InvalidArgumentError(absl::StrFormat(
      "its bytes have the checksum %08x instead of %08x: it is damaged", sum, stated));
}

}  // namespace bccskel
