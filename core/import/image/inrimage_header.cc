// Inrimage: keys and values in a block that ends with "##}".
#include <string>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"

namespace bccskel {
namespace {

constexpr std::string_view kInrMagic = "#INRIMAGE-4#{";
constexpr std::string_view kEnd = "##}";

absl::StatusOr<VoxelType> InrTypeOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view kind, fields.Require({"TYPE"}));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view bits, fields.Require({"PIXSIZE"}));
  const char letter = kind == "unsigned fixed" ? 'u'
                      : kind == "signed fixed" ? 'i'
                      : kind == "float"        ? 'f'
                                               : '?';
  const std::string_view number = bits.substr(0, bits.find(" bits"));
  const auto type = ParseVoxelType(absl::StrFormat("%c%s", letter, std::string(number)));
  if (type.ok() && bits.ends_with(" bits")) return *type;
  return BadField("TYPE and PIXSIZE", std::string(kind) + " " + std::string(bits),
                  "are not a type of numbers that is read");
}

absl::StatusOr<std::endian> InrByteOrderOf(const HeaderFields& fields, VoxelType type) {
  if (VoxelBytes(type) == 1) return std::endian::little;
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view cpu, fields.Require({"CPU"}));
  if (cpu == "decm" || cpu == "alpha" || cpu == "pc") return std::endian::little;
  if (cpu == "sun" || cpu == "sgi") return std::endian::big;
  return BadField("CPU", cpu, "is none of decm, alpha, pc, sun and sgi");
}

absl::Status CheckInrSupported(const HeaderFields& fields) {
  const std::string_view components = fields.Find({"VDIM"}).value_or("1");
  if (components != "1") return BadField("VDIM", components, "must be 1: choose one component");
  const std::string_view scale = fields.Find({"SCALE"}).value_or("2**0");
  if (scale == "2**0") return absl::OkStatus();
  return absl::UnimplementedError(
      absl::StrFormat("SCALE %s is not supported, only 2**0 is", std::string(scale.substr(0, 80))));
}

absl::StatusOr<ImageSize> InrSizeOf(const HeaderFields& fields, const ImageLimits& limits) {
  std::array<int64_t, 3> lengths;
  constexpr std::array<std::string_view, 3> kKeys = {"XDIM", "YDIM", "ZDIM"};
  for (size_t axis = 0; axis < 3; ++axis) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::string_view text, fields.Require({kKeys[axis]}));
    BCCSKEL_ASSIGN_OR_RETURN(lengths[axis], RequireNumber<int64_t>(kKeys[axis], text));
  }
  return SizeOfAxes(lengths, limits);
}

absl::StatusOr<Placement> InrPlacementOf(const HeaderFields& fields) {
  std::array<double, 3> spacing;
  WorldPoint origin;
  constexpr std::array<std::string_view, 3> kSpacings = {"VX", "VY", "VZ"};
  constexpr std::array<std::string_view, 3> kOrigins = {"TX", "TY", "TZ"};
  for (size_t axis = 0; axis < 3; ++axis) {
    BCCSKEL_ASSIGN_OR_RETURN(
        spacing[axis],
        RequireNumber<double>(kSpacings[axis], fields.Find({kSpacings[axis]}).value_or("1")));
    BCCSKEL_ASSIGN_OR_RETURN(
        origin[axis],
        RequireNumber<double>(kOrigins[axis], fields.Find({kOrigins[axis]}).value_or("0")));
  }
  return PlacementOfSpacing(spacing, origin);
}

HeaderLine ClassifyInrLine(std::string_view line) {
  if (Trimmed(line) == kEnd) return HeaderLine::kEnd;
  const bool ignored = line.starts_with('#') || Trimmed(line).empty();
  return ignored ? HeaderLine::kIgnored : HeaderLine::kField;
}

}  // namespace

bool IsInrimage(std::string_view front) { return front.starts_with(kInrMagic); }

absl::StatusOr<StoredImage> ParseInrimage(const ImageFront& front, const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const HeaderFields fields,
                           HeaderFields::Read(front.bytes, {"=", ClassifyInrLine}));
  BCCSKEL_ASSIGN_OR_RETURN(const size_t header_bytes, fields.Bytes());
  BCCSKEL_RETURN_IF_ERROR(CheckInrSupported(fields));
  StoredImage image;
  image.info.format = "Inrimage";
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, InrSizeOf(fields, limits));
  BCCSKEL_ASSIGN_OR_RETURN(image.stored_type, InrTypeOf(fields));
  BCCSKEL_ASSIGN_OR_RETURN(image.byte_order, InrByteOrderOf(fields, image.stored_type));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.placement, InrPlacementOf(fields));
  BCCSKEL_RETURN_IF_ERROR(PlaceBehindHeader(front, header_bytes, Compression::kNone, image));
  return image;
}

}  // namespace bccskel
