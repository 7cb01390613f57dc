#include "core/import/mesh/scalar.h"

#include <array>
#include <cstdint>

#include "core/import/mesh/text_scanner.h"

namespace bccskel {

std::optional<Scalar> ScalarNamed(std::string_view name) {
  constexpr std::array<std::string_view, 10> kNames = {"int8",    "uint8",  "int16", "uint16",
                                                       "int32",   "uint32", "int64", "uint64",
                                                       "float32", "float64"};
  for (size_t n = 0; n < kNames.size(); ++n) {
    if (EqualsIgnoringCase(kNames[n], name)) return static_cast<Scalar>(n);
  }
  return std::nullopt;
}

size_t ScalarBytes(Scalar type) {
  constexpr std::array<size_t, 10> kBytes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<size_t>(type)];
}

double ScalarAt(const char* bytes, Scalar type, std::endian order) {
  const size_t size = ScalarBytes(type);
  uint64_t raw = 0;
  for (size_t n = 0; n < size; ++n) {
    raw = raw << 8 | static_cast<uint8_t>(bytes[order == std::endian::big ? n : size - 1 - n]);
  }
  switch (type) {
    case Scalar::kInt8:
      return static_cast<int8_t>(raw);
    case Scalar::kInt16:
      return static_cast<int16_t>(raw);
    case Scalar::kInt32:
      return static_cast<int32_t>(raw);
    case Scalar::kInt64:
      return static_cast<double>(static_cast<int64_t>(raw));
    case Scalar::kFloat32:
      return std::bit_cast<float>(static_cast<uint32_t>(raw));
    case Scalar::kFloat64:
      return std::bit_cast<double>(raw);
    case Scalar::kUint8:
    case Scalar::kUint16:
    case Scalar::kUint32:
    case Scalar::kUint64:
      break;
  }
  return static_cast<double>(raw);
}

}  // namespace bccskel
