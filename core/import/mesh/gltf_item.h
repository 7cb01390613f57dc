#ifndef BCCSKEL_CORE_IMPORT_MESH_GLTF_ITEM_H_
#define BCCSKEL_CORE_IMPORT_MESH_GLTF_ITEM_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel {

// The member of an object; null where there is none, or where `object` is none.
const nlohmann::json& GltfMember(const nlohmann::json& object, std::string_view key);

// An object of a glTF document with its name for errors, such as "accessors[3]". Holds a reference
// into the document.
class GltfItem {
 public:
  GltfItem(const nlohmann::json& json, std::string name) : json_(&json), name_(std::move(name)) {}

  // Errors: INVALID_ARGUMENT when the list of the document has no such object.
  static absl::StatusOr<GltfItem> At(const nlohmann::json& document, const char* list,
                                     uint64_t index);

  const nlohmann::json& operator[](std::string_view key) const { return GltfMember(*json_, key); }
  bool Has(std::string_view key) const { return !(*this)[key].is_null(); }
  GltfItem Inside(std::string_view key) const;

  // Errors: INVALID_ARGUMENT for what is no whole number of 0 to 2^40.
  absl::StatusOr<uint64_t> Whole(std::string_view key) const;
  absl::StatusOr<uint64_t> WholeOr(std::string_view key, uint64_t otherwise) const;
  // A list; empty when it is not there. Errors: INVALID_ARGUMENT for other values.
  absl::StatusOr<std::vector<uint64_t>> Wholes(std::string_view key) const;
  // `count` numbers. Errors: INVALID_ARGUMENT for other values.
  absl::StatusOr<std::vector<double>> Numbers(std::string_view key, size_t count) const;
  // The text; empty when it is none.
  std::string_view Text(std::string_view key) const;

  // INVALID_ARGUMENT: "glTF accessors[3]: what".
  absl::Status Error(std::string_view what) const;

 private:
  const nlohmann::json* json_;
  std::string name_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_GLTF_ITEM_H_
