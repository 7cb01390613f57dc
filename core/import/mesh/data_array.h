#ifndef BCCSKEL_CORE_IMPORT_MESH_DATA_ARRAY_H_
#define BCCSKEL_CORE_IMPORT_MESH_DATA_ARRAY_H_

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/statusor.h"
#include "core/import/mesh/scalar.h"

namespace bccskel {

// Numbers as a file of VTK or GIFTI stores them: values of one type, one after the other.
class DataArray {
 public:
  DataArray() = default;
  // Bytes behind the last whole number are dropped.
  DataArray(std::string bytes, Scalar type, std::endian order)
      : bytes_(std::move(bytes)), type_(type), order_(order) {}

  // The numbers of a text, until it ends.
  // Errors: INVALID_ARGUMENT for a word that is no number; names `format`.
  static absl::StatusOr<DataArray> FromText(std::string_view format, std::string_view text);

  // Grows by one number. Needs: an array of doubles in the order of this machine, as by default.
  void Append(double value);

  size_t size() const { return bytes_.size() / ScalarBytes(type_); }
  double operator[](size_t n) const {
    return ScalarAt(bytes_.data() + n * ScalarBytes(type_), type_, order_);
  }

 private:
  std::string bytes_;
  Scalar type_ = Scalar::kFloat64;
  std::endian order_ = std::endian::native;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_DATA_ARRAY_H_
