// PLY: the x, y, z of the elements "vertex" and the list vertex_indices (or vertex_index) of the
// elements "face"; every other element and property is stepped over.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/ply_header.h"
#include "core/import/mesh/scalar.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

// What a property means to us.
enum class PlyRole { kNone, kX, kY, kZ, kCorners };

PlyRole RoleOf(const PlyElement& element, const PlyProperty& property) {
  if (element.name == "vertex" && !property.list_count) {
    if (property.name == "x") return PlyRole::kX;
    if (property.name == "y") return PlyRole::kY;
    if (property.name == "z") return PlyRole::kZ;
  }
  const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
  return element.name == "face" && property.list_count && corners ? PlyRole::kCorners
                                                                  : PlyRole::kNone;
}

// Values of the body one after the other, in any of the three encodings. Every integer type of PLY
// and float fit a double without loss.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, PlyEncoding encoding)
      : bytes_(bytes),
        encoding_(encoding),
        order_(encoding == PlyEncoding::kBigEndian ? std::endian::big : std::endian::little),
        text_(bytes, TextScanner::Comments::kNone, LineContinuation::kNone) {}

  std::optional<double> Next(Scalar type) {
    if (encoding_ == PlyEncoding::kAscii) return ParseDouble(text_.TokenAcrossLines());
    const size_t size = ScalarBytes(type);
    if (bytes_.size() < size) return std::nullopt;
    const double value = ScalarAt(bytes_.data(), type, order_);
    bytes_.remove_prefix(size);
    return value;
  }

  // False if the rest of the file cannot hold that many values.
  bool CanHold(uint64_t count, Scalar type) const {
    const size_t size = encoding_ == PlyEncoding::kAscii ? 1 : ScalarBytes(type);
    return count <= bytes_.size() / size;
  }

 private:
  std::string_view bytes_;
  PlyEncoding encoding_;
  std::endian order_;
  TextScanner text_;
};

absl::Status CutError(const PlyElement& element, uint64_t index) {
  return absl::InvalidArgumentError(
      absl::StrFormat("PLY file ends or has no number in element '%s' %d of %d",
                      element.name.substr(0, 40), index, element.count));
}

// Reads one element; what it means goes to `vertex` and `corners`.
absl::Status ParseOne(PlyBody& body, const PlyElement& element, uint64_t index,
                      TriangleMesh::Vertex& vertex, std::vector<int64_t>& corners) {
  for (const PlyProperty& property : element.properties) {
    const PlyRole role = RoleOf(element, property);
    uint64_t count = 1;
    if (property.list_count) {
      const std::optional<double> length = body.Next(*property.list_count);
      if (!length) return CutError(element, index);
      if (*length < 0 || *length > 4294967295.0 || *length != std::floor(*length) ||
          !body.CanHold(static_cast<uint64_t>(*length), property.type)) {
        return absl::InvalidArgumentError(
            absl::StrFormat("PLY element '%s' %d has a list of %g values, more than follow",
                            element.name.substr(0, 40), index, *length));
      }
      count = static_cast<uint64_t>(*length);
    }
    for (uint64_t n = 0; n < count; ++n) {
      const std::optional<double> value = body.Next(property.type);
      if (!value) return CutError(element, index);
      if (role == PlyRole::kCorners) {
        if (!(std::abs(*value) < 1e15) || *value != std::floor(*value)) {
          return absl::InvalidArgumentError(
              absl::StrFormat("PLY face %d has the vertex index %g", index, *value));
        }
        corners.push_back(static_cast<int64_t>(*value));
      } else if (role != PlyRole::kNone) {
        vertex[static_cast<size_t>(role) - static_cast<size_t>(PlyRole::kX)] = *value;
      }
    }
  }
  return absl::OkStatus();
}

absl::Status ParseElements(PlyBody& body, const PlyElement& element, MeshAssembler& mesh) {
  if (element.properties.empty()) return absl::OkStatus();
  std::vector<int64_t> corners;
  for (uint64_t index = 0; index < element.count; ++index) {
    TriangleMesh::Vertex vertex = {};
    corners.clear();
    BCCSKEL_RETURN_IF_ERROR(ParseOne(body, element, index, vertex, corners));
    if (element.name == "vertex") BCCSKEL_RETURN_IF_ERROR(mesh.AddVertex(vertex));
    BCCSKEL_RETURN_IF_ERROR(mesh.AddPolygon(corners));
  }
  return absl::OkStatus();
}

// Each of x, y, z and the corners exactly once.
absl::Status CheckRoles(const PlyHeader& header) {
  std::array<int, 5> seen = {};
  for (const PlyElement& element : header.elements) {
    for (const PlyProperty& property : element.properties) {
      ++seen[static_cast<size_t>(RoleOf(element, property))];
    }
  }
  for (size_t role = 1; role < seen.size(); ++role) {
    if (seen[role] != 1) {
      return absl::InvalidArgumentError(
          "PLY file must have one element 'vertex' with x, y, z and one element 'face' with the "
          "list vertex_indices");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<TriangleMesh> ParsePly(std::string_view bytes, const MeshLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const PlyHeader header, ParsePlyHeader(bytes));
  BCCSKEL_RETURN_IF_ERROR(CheckRoles(header));
  PlyBody body(bytes.substr(header.body_offset), header.encoding);
  MeshAssembler mesh(limits);
  for (const PlyElement& element : header.elements) {
    BCCSKEL_RETURN_IF_ERROR(ParseElements(body, element, mesh));
  }
  return std::move(mesh).Finish();
}

}  // namespace bccskel
