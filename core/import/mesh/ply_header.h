#ifndef BCCSKEL_CORE_IMPORT_MESH_PLY_HEADER_H_
#define BCCSKEL_CORE_IMPORT_MESH_PLY_HEADER_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/mesh/scalar.h"

namespace bccskel {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::kFloat32;    // of the value, or of each value of a list
  std::optional<Scalar> list_count;  // type of the count; set for lists only
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // Fewest bytes one element can take.
  uint64_t MinimumBytes(PlyEncoding encoding) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  size_t body_offset = 0;  // first byte behind the line "end_header"
};

// Errors: INVALID_ARGUMENT for an unknown line, type or encoding, a bad count, or elements that
//         need more bytes than the file has. (Counts are checked one element at a time; the sum is
//         found out by reading.)
absl::StatusOr<PlyHeader> ParsePlyHeader(std::string_view bytes);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_PLY_HEADER_H_
