#ifndef BCCSKEL_CORE_IMPORT_MESH_GLTF_BUFFERS_H_
#define BCCSKEL_CORE_IMPORT_MESH_GLTF_BUFFERS_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/mesh/gltf_item.h"

namespace bccskel {

// A glTF file, taken apart: text, or the binary container (.glb) of a text and one buffer.
struct GltfFile {
  nlohmann::json document;
  std::optional<std::string_view> binary;
};
// Errors: INVALID_ARGUMENT (cut, another version, no JSON object), RESOURCE_EXHAUSTED
// (CheckMarks()).
absl::StatusOr<GltfFile> ParseGltfFile(std::string_view bytes);
bool IsGlb(std::string_view bytes);

// The buffers of a document: of the container, in the document as base64, or in files of its
// folder. Each is read when it is first asked for; buffers that name the same file share it.
class GltfBuffers {
 public:
  // `file` must outlive this object. `folder`: where files may be; none are read without.
  GltfBuffers(const GltfFile& file, std::optional<std::string> folder, uint64_t max_bytes)
      : file_(file), folder_(std::move(folder)), bytes_left_(max_bytes) {}

  // Errors: INVALID_ARGUMENT (not there, shorter than it declares, a URL, a file outside the
  //         folder), NOT_FOUND, RESOURCE_EXHAUSTED (files of more than max_bytes in all).
  absl::StatusOr<std::string_view> Buffer(uint64_t index);

  uint64_t bytes_of_files() const { return bytes_of_files_; }

 private:
  absl::StatusOr<std::string_view> Stored(const GltfItem& buffer, uint64_t index);
  absl::StatusOr<std::string> Decoded(const GltfItem& buffer, std::string_view uri) const;
  absl::StatusOr<std::string> PathOf(const GltfItem& buffer, std::string_view uri) const;
  absl::StatusOr<std::string> ReadPath(const GltfItem& buffer, const std::string& path);

  const GltfFile& file_;
  std::optional<std::string> folder_;
  uint64_t bytes_left_;
  uint64_t bytes_of_files_ = 0;
  std::map<std::string, std::string> read_;  // by path, or by the name of the buffer
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_GLTF_BUFFERS_H_
