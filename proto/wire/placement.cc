#include "proto/wire/placement.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/error_details.h"

namespace bccskel::wire {
namespace {

using RepeatedDouble = google::protobuf::RepeatedField<double>;

absl::StatusOr<int32_t> CellsOf(uint32_t cells, const std::string& field) {
  if (cells == 0 || cells > static_cast<uint32_t>(kMaxExtentCells)) {
    return InvalidField(field, absl::StrCat(cells, " cells, must be 1 to ", kMaxExtentCells));
  }
  return static_cast<int32_t>(cells);
}

template <size_t kSize>
absl::StatusOr<std::array<double, kSize>> ValuesOf(const RepeatedDouble& values,
                                                   const std::array<double, kSize>& absent,
                                                   const std::string& field) {
  if (values.empty()) return absent;
  if (static_cast<size_t>(values.size()) != kSize) {
    return InvalidField(field, absl::StrCat(values.size(), " values, must be ", kSize));
  }
  for (double value : values) {
    if (!std::isfinite(value)) {
      return InvalidField(field, absl::StrCat("value ", value, " is not finite"));
    }
  }
  std::array<double, kSize> array;
  std::copy(values.begin(), values.end(), array.begin());
  return array;
}

}  // namespace

v1::LatticeExtent ToMessage(const LatticeExtent& extent) {
  v1::LatticeExtent message;
  message.set_nx(static_cast<uint32_t>(extent.nx));
  message.set_ny(static_cast<uint32_t>(extent.ny));
  message.set_nz(static_cast<uint32_t>(extent.nz));
  return message;
}

v1::Placement ToMessage(const Placement& placement) {
  v1::Placement message;
  message.mutable_spacing()->Add(placement.spacing.begin(), placement.spacing.end());
  message.mutable_origin()->Add(placement.origin.begin(), placement.origin.end());
  message.mutable_direction()->Add(placement.direction.begin(), placement.direction.end());
  return message;
}

absl::StatusOr<LatticeExtent> FromMessage(const v1::LatticeExtent& message,
                                          const std::string& field) {
  LatticeExtent extent;
  BCCSKEL_ASSIGN_OR_RETURN(extent.nx, CellsOf(message.nx(), field + ".nx"));
  BCCSKEL_ASSIGN_OR_RETURN(extent.ny, CellsOf(message.ny(), field + ".ny"));
  BCCSKEL_ASSIGN_OR_RETURN(extent.nz, CellsOf(message.nz(), field + ".nz"));
  return extent;
}

absl::StatusOr<Placement> FromMessage(const v1::Placement& message, const std::string& field) {
  Placement p;
  BCCSKEL_ASSIGN_OR_RETURN(p.spacing, ValuesOf(message.spacing(), p.spacing, field + ".spacing"));
  BCCSKEL_ASSIGN_OR_RETURN(p.origin, ValuesOf(message.origin(), p.origin, field + ".origin"));
  BCCSKEL_ASSIGN_OR_RETURN(p.direction,
                           ValuesOf(message.direction(), p.direction, field + ".direction"));
  const double smallest = *std::min_element(p.spacing.begin(), p.spacing.end());
  if (smallest <= 0) {
    return InvalidField(field + ".spacing", absl::StrCat(smallest, ", must be positive"));
  }
  const absl::Status checked = CheckPlacement(p);
  if (!checked.ok()) return InvalidField(field, std::string(checked.message()));
  return p;
}

}  // namespace bccskel::wire
