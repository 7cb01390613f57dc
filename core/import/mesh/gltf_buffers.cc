#include "core/import/mesh/gltf_buffers.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/scalar.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

constexpr uint32_t kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;  // types of chunks
constexpr size_t kGlbHeader = 12, kGlbChunkHeader = 8;

uint64_t GlbWord(std::string_view bytes, size_t at) {
  return static_cast<uint64_t>(ScalarAt(bytes.data() + at, Scalar::kUint32, std::endian::little));
}

struct GlbChunk {
  uint64_t type = 0;
  std::string_view bytes;
};

// Takes a chunk off the front. Errors: INVALID_ARGUMENT when it is cut.
absl::StatusOr<GlbChunk> TakeGlbChunk(std::string_view& rest) {
  const uint64_t length = rest.size() < kGlbChunkHeader ? 0 : GlbWord(rest, 0);
  if (rest.size() < kGlbChunkHeader || length > rest.size() - kGlbChunkHeader) {
    return absl::InvalidArgumentError(
        absl::StrFormat("glTF: a chunk of %d bytes is declared, %d bytes are left: is it cut?",
                        length, rest.size()));
  }
  const GlbChunk chunk = {GlbWord(rest, 4), rest.substr(kGlbChunkHeader, length)};
  rest.remove_prefix(kGlbChunkHeader + length);
  return chunk;
}

struct GlbParts {
  std::string_view json;
  std::optional<std::string_view> binary;
};

absl::StatusOr<GlbParts> SplitGlb(std::string_view bytes) {
  const uint64_t version = bytes.size() < kGlbHeader ? 0 : GlbWord(bytes, 4);
  const uint64_t length = bytes.size() < kGlbHeader ? kGlbHeader : GlbWord(bytes, 8);
  if (length > bytes.size() || length < kGlbHeader) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "glTF: the file declares %d bytes and has %d: is it cut?", length, bytes.size()));
  }
  if (version != 2) {
    return absl::InvalidArgumentError(
        absl::StrFormat("glTF: version %d of the container; 2 is read", version));
  }
  std::string_view rest = bytes.substr(kGlbHeader, length - kGlbHeader);
  BCCSKEL_ASSIGN_OR_RETURN(const GlbChunk json, TakeGlbChunk(rest));
  if (json.type != kGlbJson) {
    return absl::InvalidArgumentError(
        absl::StrFormat("glTF: the first chunk has the type %#x, not that of JSON", json.type));
  }
  GlbParts parts = {json.bytes, std::nullopt};
  if (rest.empty()) return parts;
  BCCSKEL_ASSIGN_OR_RETURN(const GlbChunk binary, TakeGlbChunk(rest));
  if (binary.type == kGlbBinary) parts.binary = binary.bytes;
  return parts;
}

// Percent signs stand for bytes.
std::string DecodeUri(std::string_view uri) {
  std::string decoded;
  for (size_t n = 0; n < uri.size(); ++n) {
    const bool escaped = uri[n] == '%' && n + 2 < uri.size() &&
                         absl::ascii_isxdigit(static_cast<unsigned char>(uri[n + 1])) &&
                         absl::ascii_isxdigit(static_cast<unsigned char>(uri[n + 2]));
    if (escaped) {
      decoded += absl::HexStringToBytes(std::string(uri.substr(n + 1, 2)));
      n += 2;
    } else {
      decoded.push_back(uri[n]);
    }
  }
  return decoded;
}

bool IsInside(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

}  // namespace

bool IsGlb(std::string_view bytes) { return bytes.starts_with("glTF"); }

absl::StatusOr<GltfFile> ParseGltfFile(std::string_view bytes) {
  GlbParts parts = {bytes, std::nullopt};
  if (IsGlb(bytes)) {
    BCCSKEL_ASSIGN_OR_RETURN(parts, SplitGlb(bytes));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckMarks("glTF", parts.json, "{[,"));
  GltfFile file = {nlohmann::json::parse(parts.json, nullptr, /*allow_exceptions=*/false),
                   parts.binary};
  if (!file.document.is_object()) {
    return absl::InvalidArgumentError("glTF: the text is no JSON object, or it is cut");
  }
  return file;
}

absl::StatusOr<std::string_view> GltfBuffers::Buffer(uint64_t index) {
  BCCSKEL_ASSIGN_OR_RETURN(const GltfItem buffer, GltfItem::At(file_.document, "buffers", index));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t length, buffer.Whole("byteLength"));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view bytes, Stored(buffer, index));
  if (length <= bytes.size()) return bytes.substr(0, length);
  return buffer.Error(absl::StrFormat("byteLength is %d, but there are %d bytes: is it cut?",
                                      length, bytes.size()));
}

absl::StatusOr<std::string_view> GltfBuffers::Stored(const GltfItem& buffer, uint64_t index) {
  const std::string_view uri = buffer.Text("uri");
  if (uri.empty()) {
    if (index == 0 && file_.binary) return *file_.binary;
    return buffer.Error("has no uri, and the file has no binary chunk for it");
  }
  const bool embedded = uri.starts_with("data:");
  std::string key = absl::StrFormat("buffers[%d]", index);
  if (!embedded) {
    BCCSKEL_ASSIGN_OR_RETURN(key, PathOf(buffer, uri));
  }
  const auto known = read_.find(key);
  if (known != read_.end()) return known->second;
  BCCSKEL_ASSIGN_OR_RETURN(std::string bytes,
                           embedded ? Decoded(buffer, uri) : ReadPath(buffer, key));
  return read_.emplace(std::move(key), std::move(bytes)).first->second;
}

absl::StatusOr<std::string> GltfBuffers::Decoded(const GltfItem& buffer,
                                                 std::string_view uri) const {
  constexpr std::string_view kBase64 = ";base64,";
  const size_t mark = uri.substr(0, 256).find(kBase64);
  if (mark != uri.npos) {
    const std::string_view text = uri.substr(mark + kBase64.size());
    std::string bytes;
    if (absl::Base64Unescape({text.data(), text.size()}, &bytes)) return bytes;
  }
  return buffer.Error("its data: uri is not base64");
}

// Where the file is, without links. Errors: INVALID_ARGUMENT for a URL and outside the folder.
absl::StatusOr<std::string> GltfBuffers::PathOf(const GltfItem& buffer,
                                                std::string_view uri) const {
  const std::string name = DecodeUri(uri.substr(0, 4096));
  const auto refuse = [&](std::string_view why) {
    return buffer.Error(absl::StrFormat("its uri is '%s': %s", name.substr(0, 200), why));
  };
  if (!folder_) return refuse("files beside the mesh can be read for files alone");
  if (name.find(':') != name.npos || name.find('\0') != name.npos) {
    return refuse("URLs are not read; put the file beside the mesh");
  }
  std::error_code error;
  const auto folder = std::filesystem::canonical(*folder_, error);
  const auto path = std::filesystem::weakly_canonical(folder / name, error);
  if (!IsInside(path, folder)) return refuse("only files in the folder of the mesh are read");
  return path.string();
}

absl::StatusOr<std::string> GltfBuffers::ReadPath(const GltfItem& buffer, const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return absl::NotFoundError(
        absl::StrFormat("%s is not there or no file", buffer.Error(path).message()));
  }
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error || size > bytes_left_) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("glTF buffer '%s' has %d bytes, %d are left of the limit of a mesh", path,
                        size, bytes_left_));
  }
  std::string bytes(size, '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) {
    return absl::PermissionDeniedError(absl::StrFormat("cannot read glTF buffer '%s'", path));
  }
  bytes_left_ -= size;
  bytes_of_files_ += size;
  return bytes;
}

}  // namespace bccskel
