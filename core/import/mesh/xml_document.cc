#include "core/import/mesh/xml_document.h"

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {

absl::StatusOr<pugi::xml_document> ParseXml(std::string_view format, std::string_view text) {
  BCCSKEL_RETURN_IF_ERROR(CheckMarks(format, text, "<="));
  pugi::xml_document document;
  const pugi::xml_parse_result parsed =
      document.load_buffer(text.data(), text.size(), pugi::parse_cdata, pugi::encoding_utf8);
  if (parsed) return document;
  if (parsed.status == pugi::status_out_of_memory) {
    return absl::ResourceExhaustedError("not enough memory for the XML document");
  }
  return absl::InvalidArgumentError(absl::StrFormat("%s is not well-formed XML at byte %d: %s",
                                                    format, parsed.offset, parsed.description()));
}

std::string_view XmlAttribute(const pugi::xml_node& node, const char* name) {
  return node.attribute(name).value();
}

absl::StatusOr<uint64_t> XmlCount(std::string_view format, const pugi::xml_node& node,
                                  const char* name) {
  const std::string_view text = XmlAttribute(node, name);
  const std::optional<int64_t> count = ParseInteger(text);
  if (count && *count >= 0) return static_cast<uint64_t>(*count);
  return absl::InvalidArgumentError(
      absl::StrFormat("%s: %s of <%s> must be a count of 0 or more, is '%s'", format, name,
                      node.name(), text.substr(0, 40)));
}

}  // namespace bccskel
