#include "core/import/mesh/ply_header.h"

#include <array>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

// Beside the names of ScalarNamed().
constexpr std::array<std::pair<std::string_view, Scalar>, 8> kTypeNames = {{
    {"char", Scalar::kInt8},
    {"uchar", Scalar::kUint8},
    {"short", Scalar::kInt16},
    {"ushort", Scalar::kUint16},
    {"int", Scalar::kInt32},
    {"uint", Scalar::kUint32},
    {"float", Scalar::kFloat32},
    {"double", Scalar::kFloat64},
}};

absl::Status HeaderError(std::string_view what, std::string_view found) {
  return absl::InvalidArgumentError(absl::StrFormat("PLY header: %s, found '%s'", std::string(what),
                                                    std::string(found.substr(0, 40))));
}

absl::StatusOr<Scalar> ParseType(std::string_view name) {
  for (const auto& [known, type] : kTypeNames) {
    if (known == name) return type;
  }
  if (const std::optional<Scalar> type = ScalarNamed(name); type) return *type;
  return HeaderError("expected a type of a property", name);
}

absl::StatusOr<PlyEncoding> ParseEncoding(std::string_view name) {
  if (name == "ascii") return PlyEncoding::kAscii;
  if (name == "binary_little_endian") return PlyEncoding::kLittleEndian;
  if (name == "binary_big_endian") return PlyEncoding::kBigEndian;
  return HeaderError("expected the format ascii, binary_little_endian or binary_big_endian", name);
}

absl::StatusOr<PlyElement> ParseElement(TextScanner& line) {
  PlyElement element;
  element.name = std::string(line.Token());
  const std::string_view token = line.Token();
  const std::optional<int64_t> count = ParseInteger(token);
  if (!count || *count < 0) return HeaderError("expected a count of 0 or more elements", token);
  element.count = static_cast<uint64_t>(*count);
  return element;
}

absl::StatusOr<PlyProperty> ParseProperty(TextScanner& line) {
  PlyProperty property;
  std::string_view type = line.Token();
  if (type == "list") {
    BCCSKEL_ASSIGN_OR_RETURN(property.list_count, ParseType(line.Token()));
    if (IsFloat(*property.list_count)) {
      return HeaderError("expected an integer type for the length of a list", type);
    }
    type = line.Token();
  }
  BCCSKEL_ASSIGN_OR_RETURN(property.type, ParseType(type));
  property.name = std::string(line.Token());
  return property;
}

absl::Status ParseLine(std::string_view text, PlyHeader& header) {
  TextScanner line(text, TextScanner::Comments::kNone, LineContinuation::kNone);
  if (!line.NextLine()) return absl::OkStatus();
  const std::string_view keyword = line.Token();
  if (keyword == "ply" || keyword == "comment" || keyword == "obj_info") return absl::OkStatus();
  if (keyword == "Created") return absl::OkStatus();  // a remark of Blender 2.4
  if (keyword == "format") {
    BCCSKEL_ASSIGN_OR_RETURN(header.encoding, ParseEncoding(line.Token()));
    return absl::OkStatus();
  }
  if (keyword == "element") {
    BCCSKEL_ASSIGN_OR_RETURN(PlyElement element, ParseElement(line));
    header.elements.push_back(std::move(element));
    return absl::OkStatus();
  }
  if (keyword == "property" && !header.elements.empty()) {
    BCCSKEL_ASSIGN_OR_RETURN(PlyProperty property, ParseProperty(line));
    header.elements.back().properties.push_back(std::move(property));
    return absl::OkStatus();
  }
  return HeaderError("expected format, element, property, comment or end_header", keyword);
}

absl::Status CheckCounts(const PlyHeader& header, uint64_t body_bytes) {
  for (const PlyElement& element : header.elements) {
    const uint64_t minimum = element.MinimumBytes(header.encoding);
    if (minimum > 0 && element.count > body_bytes / minimum) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "PLY header declares %d elements '%s' of at least %d bytes; %d bytes follow",
          element.count, element.name.substr(0, 40), minimum, body_bytes));
    }
  }
  return absl::OkStatus();
}

}  // namespace

uint64_t PlyElement::MinimumBytes(PlyEncoding encoding) const {
  uint64_t bytes = 0;
  for (const PlyProperty& property : properties) {
    bytes += encoding == PlyEncoding::kAscii ? 1
             : property.list_count           ? ScalarBytes(*property.list_count)
                                             : ScalarBytes(property.type);
  }
  return bytes;
}

absl::StatusOr<PlyHeader> ParsePlyHeader(std::string_view bytes) {
  PlyHeader header;
  size_t at = 0;
  while (at < bytes.size()) {
    const size_t end = std::min(bytes.find_first_of("\r\n", at), bytes.size());
    const std::string_view line = bytes.substr(at, end - at);
    at = std::min(end + 1, bytes.size());
    if (bytes.substr(end, 2) == "\r\n") ++at;
    if (line.starts_with("end_header")) {
      header.body_offset = at;
      BCCSKEL_RETURN_IF_ERROR(CheckCounts(header, bytes.size() - at));
      return header;
    }
    BCCSKEL_RETURN_IF_ERROR(ParseLine(line, header));
  }
  return absl::InvalidArgumentError("PLY header has no line 'end_header'");
}

}  // namespace bccskel
