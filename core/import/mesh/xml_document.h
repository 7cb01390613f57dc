#ifndef BCCSKEL_CORE_IMPORT_MESH_XML_DOCUMENT_H_
#define BCCSKEL_CORE_IMPORT_MESH_XML_DOCUMENT_H_

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace bccskel {

// Elements, attributes and texts. Nothing outside the text is ever read: no entities, no DTD.
// Errors: INVALID_ARGUMENT for what is no XML, RESOURCE_EXHAUSTED as in CheckMarks().
absl::StatusOr<pugi::xml_document> ParseXml(std::string_view format, std::string_view text);

// The attribute's text; empty when it is not there.
std::string_view XmlAttribute(const pugi::xml_node& node, const char* name);

// Errors: INVALID_ARGUMENT when the attribute is missing or no count of 0 or more.
absl::StatusOr<uint64_t> XmlCount(std::string_view format, const pugi::xml_node& node,
                                  const char* name);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_XML_DOCUMENT_H_
