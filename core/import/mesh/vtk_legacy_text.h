#ifndef BCCSKEL_CORE_IMPORT_MESH_VTK_LEGACY_TEXT_H_
#define BCCSKEL_CORE_IMPORT_MESH_VTK_LEGACY_TEXT_H_

#include <cstdint>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/mesh/data_array.h"

namespace bccskel {

// A legacy file of VTK from front to end: keywords in text, numbers in text or big-endian bytes.
class VtkLegacyText {
 public:
  enum class Numbers { kText, kBigEndian };

  explicit VtkLegacyText(std::string_view bytes) : all_(bytes), rest_(bytes) {}

  void SetNumbers(Numbers numbers) { numbers_ = numbers; }

  // The next word; empty at the end.
  std::string_view Word();
  // What follows of this line; goes behind its end.
  std::string_view Line();
  bool AtEnd() const { return rest_.empty(); }

  // The word as a number. Errors: INVALID_ARGUMENT if it is no whole number of 0 or more.
  absl::StatusOr<uint64_t> Count(std::string_view word) const;
  // `count` numbers of a type that VTK names; bytes begin behind the end of this line.
  // Errors: INVALID_ARGUMENT for another type, for a word that is no number and if fewer follow.
  absl::StatusOr<DataArray> Values(uint64_t count, std::string_view type);

  // INVALID_ARGUMENT: "VTK line 7: expected a number, found 'x'".
  absl::Status Error(std::string_view expected, std::string_view found) const;

 private:
  std::string_view all_;
  std::string_view rest_;
  Numbers numbers_ = Numbers::kText;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_VTK_LEGACY_TEXT_H_
