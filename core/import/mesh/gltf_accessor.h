#ifndef BCCSKEL_CORE_IMPORT_MESH_GLTF_ACCESSOR_H_
#define BCCSKEL_CORE_IMPORT_MESH_GLTF_ACCESSOR_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/mesh/gltf_buffers.h"
#include "core/import/mesh/gltf_item.h"
#include "core/import/mesh/scalar.h"

namespace bccskel {

// What the accessors of a document hold. A document may show the same numbers again and again, so
// that a small file stands for a large scene: what is read is limited to a multiple of its bytes.
class GltfAccessors {
 public:
  // `document_bytes` is the length of the file; the other arguments must outlive this object.
  GltfAccessors(const GltfFile& file, GltfBuffers& buffers, uint64_t document_bytes)
      : file_(file), buffers_(buffers), document_bytes_(document_bytes) {}

  // x, y, z one after the other: floats, or integers (KHR_mesh_quantization).
  // Errors: INVALID_ARGUMENT (malformed, or it reaches beyond its buffer), those of Charge() and of
  //         GltfBuffers::Buffer().
  absl::StatusOr<std::vector<double>> Positions(uint64_t index);
  // Errors: as above.
  absl::StatusOr<std::vector<double>> Indices(uint64_t index);

  // Errors: RESOURCE_EXHAUSTED when more is read than the limit, with these numbers.
  absl::Status Charge(uint64_t numbers);

 private:
  // Rows of numbers in a buffer; `bytes` ends with the last row.
  struct Rows {
    std::string_view bytes;
    uint64_t count = 0;
    uint64_t stride = 0;
    uint64_t columns = 1;
    Scalar type = Scalar::kFloat32;

    double At(uint64_t row, uint64_t column) const {
      const uint64_t place = row * stride + column * ScalarBytes(type);
      return ScalarAt(bytes.data() + place, type, std::endian::little);
    }
  };

  absl::StatusOr<std::vector<double>> Read(const GltfItem& accessor, uint64_t columns);
  absl::StatusOr<Rows> RowsOf(const GltfItem& owner, uint64_t count, uint64_t columns, Scalar type);
  absl::Status ReplaceSparse(const GltfItem& accessor, Scalar type, uint64_t columns,
                             std::vector<double>& values);

  const GltfFile& file_;
  GltfBuffers& buffers_;
  uint64_t document_bytes_;
  uint64_t charged_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_GLTF_ACCESSOR_H_
