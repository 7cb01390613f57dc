#include "core/import/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <system_error>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/file_bytes.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

enum class MeshFormat {
  kOff,
  kObj,
  kPly,
  kAsciiStl,
  kBinaryStl,
  kGltf,
  kVtkLegacy,
  kVtp,
  kGifti,
  kFreeSurfer
};

// Of the mesh file, for the files that glTF names; nothing for bytes in memory.
using Folder = std::optional<std::string>;

constexpr std::array<std::string_view, 9> kMeshEndings = {"obj",  "stl", "ply", "off", "glb",
                                                          "gltf", "vtk", "vtp", "gii"};

// "off" for "a/b.OFF.gz"; empty without a dot.
std::string EndingOf(std::string_view path) {
  std::string name(path.substr(path.find_last_of('/') + 1));
  std::ranges::transform(name, name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  const size_t dot = name.find_last_of('.');
  return dot == name.npos ? "" : name.substr(dot + 1);
}

// The first word that is not in a comment.
std::string_view FirstWord(std::string_view bytes) {
  TextScanner text(bytes, TextScanner::Comments::kHash, LineContinuation::kNone);
  return text.TokenAcrossLines();
}

bool IsObjKeyword(std::string_view word) {
  constexpr std::array<std::string_view, 9> kKeywords = {"v", "vt", "vn",     "f",     "o",
                                                         "g", "s",  "mtllib", "usemtl"};
  return std::ranges::find(kKeywords, word) != kKeywords.end();
}

// The root element of an XML file stands near its start.
std::optional<MeshFormat> SniffXml(std::string_view bytes) {
  const std::string_view front = bytes.substr(0, 4096);
  if (front.find("<VTKFile") != front.npos) return MeshFormat::kVtp;
  if (front.find("<GIFTI") != front.npos) return MeshFormat::kGifti;
  return std::nullopt;
}

// What the bytes say by themselves.
std::optional<MeshFormat> SniffContent(std::string_view bytes) {
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::kPly;
  if (bytes.starts_with("glTF")) return MeshFormat::kGltf;
  if (IsVtkLegacy(bytes)) return MeshFormat::kVtkLegacy;
  if (IsFreeSurfer(bytes)) return MeshFormat::kFreeSurfer;
  if (HasBinaryStlLength(bytes)) return MeshFormat::kBinaryStl;
  const std::string_view word = FirstWord(bytes);
  if (word.starts_with('<')) return SniffXml(bytes);
  if (word.starts_with('{')) return MeshFormat::kGltf;
  if (IsOffKeyword(word)) return MeshFormat::kOff;
  if (EqualsIgnoringCase(word, "solid")) return MeshFormat::kAsciiStl;
  if (IsObjKeyword(word)) return MeshFormat::kObj;
  return std::nullopt;
}

// "solid" also begins the free-form header of some binary files.
bool HasZeroByte(std::string_view bytes) {
  return bytes.substr(0, 512).find('\0') != std::string_view::npos;
}

absl::StatusOr<MeshFormat> ChooseFormat(std::string_view bytes, std::string_view name) {
  const std::string ending = EndingOf(name);
  const std::optional<MeshFormat> sniffed = SniffContent(bytes);
  if (sniffed == MeshFormat::kAsciiStl && HasZeroByte(bytes)) return MeshFormat::kBinaryStl;
  if (sniffed) return *sniffed;
  if (ending == "obj") return MeshFormat::kObj;
  if (ending == "off") return MeshFormat::kOff;
  if (ending == "stl") return MeshFormat::kBinaryStl;
  if (ending == "ply") return absl::InvalidArgumentError("a PLY file must begin with 'ply'");
  if (ending == "vtk") {
    return absl::InvalidArgumentError("a VTK file must begin with '# vtk DataFile Version'");
  }
  if (ending == "glb" || ending == "gltf") return MeshFormat::kGltf;
  if (ending == "vtp") return MeshFormat::kVtp;
  if (ending == "gii") return MeshFormat::kGifti;
  return absl::InvalidArgumentError(
      "format not supported: meshes are read from OBJ, STL, PLY, OFF, glTF, VTK polygon data, "
      "GIFTI and FreeSurfer files, each also .gz");
}

absl::StatusOr<TriangleMesh> ParseAs(MeshFormat format, std::string_view bytes,
                                     const Folder& folder, const MeshLimits& limits) {
  switch (format) {
    case MeshFormat::kOff:
      return ParseOff(bytes, limits);
    case MeshFormat::kObj:
      return ParseObj(bytes, limits);
    case MeshFormat::kPly:
      return ParsePly(bytes, limits);
    case MeshFormat::kAsciiStl:
      return ParseAsciiStl(bytes, limits);
    case MeshFormat::kGltf:
      return ParseGltf(bytes, folder, limits);
    case MeshFormat::kVtkLegacy:
      return ParseVtkLegacy(bytes, limits);
    case MeshFormat::kVtp:
      return ParseVtp(bytes, limits);
    case MeshFormat::kGifti:
      return ParseGifti(bytes, limits);
    case MeshFormat::kFreeSurfer:
      return ParseFreeSurfer(bytes, limits);
    case MeshFormat::kBinaryStl:
      break;
  }
  return ParseBinaryStl(bytes, limits);
}

absl::StatusOr<TriangleMesh> ChooseAndParse(std::string_view bytes, std::string_view name,
                                            const Folder& folder, const MeshLimits& limits) {
  if (bytes.empty() && EndingOf(name) != "obj") {
    return absl::InvalidArgumentError("the file is empty");
  }
  // Programs on Windows write it before text, in which it is no part of the first word.
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kByteOrderMark) && !HasBinaryStlLength(bytes)) {
    bytes.remove_prefix(kByteOrderMark.size());
  }
  BCCSKEL_ASSIGN_OR_RETURN(const MeshFormat format, ChooseFormat(bytes, name));
  return ParseAs(format, bytes, folder, limits);
}

absl::StatusOr<TriangleMesh> ParseNamed(std::string_view bytes, std::string_view name,
                                        const Folder& folder, const MeshLimits& limits) {
  try {
    absl::StatusOr<TriangleMesh> mesh = ChooseAndParse(bytes, name, folder, limits);
    if (mesh.ok()) return mesh;
    return absl::Status(mesh.status().code(), absl::StrFormat("mesh '%s': %s", std::string(name),
                                                              mesh.status().message()));
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("mesh '%s': not enough memory", std::string(name)));
  }
}

// The first bytes of a file, as many as there are; none of what is no regular file.
std::string FrontOf(const std::string& path, size_t most) {
  std::error_code ignored;  // a pipe would wait for its writer
  if (!std::filesystem::is_regular_file(path, ignored)) return "";
  std::string front(most, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(front.data(), static_cast<std::streamsize>(front.size()));
  front.resize(static_cast<size_t>(file.gcount()));
  return front;
}

bool BeginsLikeFreeSurfer(const std::string& path) { return IsFreeSurfer(FrontOf(path, 3)); }

}  // namespace

bool BeginsLikeMesh(const std::string& path) {
  const std::string front = FrontOf(path, 4096);
  std::error_code ignored;
  if (!front.empty() && IsBinaryStlOf(front, std::filesystem::file_size(path, ignored)))
    return true;
  const std::optional<MeshFormat> format = SniffContent(front);
  if (format == MeshFormat::kAsciiStl) return front.find("facet") != front.npos;
  return format.has_value() && *format != MeshFormat::kObj && *format != MeshFormat::kGltf;
}

bool IsGltfPath(const std::string& path) {
  const std::string ending = EndingOf(path);
  return ending == "glb" || ending == "gltf";
}

bool IsMeshPath(const std::string& path) {
  return std::ranges::find(kMeshEndings, EndingOf(path)) != kMeshEndings.end() ||
         BeginsLikeFreeSurfer(path);
}

absl::StatusOr<TriangleMesh> ParseMesh(std::string_view bytes, std::string_view name,
                                       const MeshLimits& limits) {
  return ParseNamed(bytes, name, std::nullopt, limits);
}

absl::StatusOr<TriangleMesh> ReadMeshFile(const std::string& path, const MeshLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path, limits.max_file_bytes));
  const size_t slash = path.find_last_of('/');
  return ParseNamed(bytes, path, slash == path.npos ? "." : path.substr(0, slash + 1), limits);
}

}  // namespace bccskel
