#ifndef BCCSKEL_CORE_IMPORT_MESH_SCALAR_H_
#define BCCSKEL_CORE_IMPORT_MESH_SCALAR_H_

#include <bit>
#include <cstddef>
#include <optional>
#include <string_view>

namespace bccskel {

// How a binary file stores a number.
enum class Scalar {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

// The type with a name such as uint8 or Float32, in letters of any size; nothing for another name.
std::optional<Scalar> ScalarNamed(std::string_view name);
size_t ScalarBytes(Scalar type);
inline bool IsFloat(Scalar type) { return type >= Scalar::kFloat32; }

// The number that the first ScalarBytes(type) bytes hold. A double holds all of them but integers
// of 64 bits beyond 2^53, which are no index of ours: those are rounded.
double ScalarAt(const char* bytes, Scalar type, std::endian order);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_SCALAR_H_
