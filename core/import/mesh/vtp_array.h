#ifndef BCCSKEL_CORE_IMPORT_MESH_VTP_ARRAY_H_
#define BCCSKEL_CORE_IMPORT_MESH_VTP_ARRAY_H_

#include <bit>
#include <cstdint>
#include <pugixml.hpp>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/mesh/data_array.h"
#include "core/import/mesh/scalar.h"
#include "core/import/mesh/stored_bytes.h"

namespace bccskel {

// Reads the elements <DataArray> of one XML file of VTK: text, base64 in place, or bytes in
// <AppendedData>; binary ones with or without zlib.
class VtpArrayReader {
 public:
  // `appended` is what stands behind the underscore in <AppendedData>; arrays may take
  // `max_expanded` bytes in all after expansion.
  // Errors: INVALID_ARGUMENT for a compressor, header type or byte order that is not read.
  static absl::StatusOr<VtpArrayReader> Make(const pugi::xml_node& file, std::string_view appended,
                                             uint64_t max_expanded);

  // Errors: INVALID_ARGUMENT (an unknown type, malformed, cut, bytes that other arrays have taken
  //         already), RESOURCE_EXHAUSTED.
  absl::StatusOr<DataArray> Read(const pugi::xml_node& array);

 private:
  enum class Compressor { kNone, kZlib };

  absl::StatusOr<StoredBytes> Stored(const pugi::xml_node& array) const;
  absl::StatusOr<uint64_t> TakeWord(StoredBytes& stored) const;
  absl::StatusOr<std::string> TakePlain(StoredBytes& stored) const;
  absl::StatusOr<std::string> TakeBlocks(StoredBytes& stored);
  absl::Status ChargeAppended(uint64_t bytes);

  std::string_view appended_;
  StoredBytes::Encoding appended_encoding_ = StoredBytes::Encoding::kRaw;
  std::endian order_ = std::endian::little;
  Scalar header_ = Scalar::kUint32;
  Compressor compressor_ = Compressor::kNone;
  uint64_t appended_left_ = 0;  // bytes of `appended_` that no array has taken
  uint64_t expanded_left_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_VTP_ARRAY_H_
