#ifndef BCCSKEL_CORE_IMPORT_IMAGE_JSON_METADATA_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_JSON_METADATA_H_

// The metadata of images that are folders: files of JSON.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/image_limits.h"

namespace bccskel {

// Nothing where there is no such file. `path` may be compressed by gzip.
// Errors: INVALID_ARGUMENT if it is not a JSON object; RESOURCE_EXHAUSTED for a file above
//         ImageLimits::max_header_bytes; errors of the system.
absl::StatusOr<std::optional<nlohmann::json>> ReadJson(const std::string& path,
                                                       const ImageLimits& limits);

// The member of an object; null where there is none, or where `object` is none.
const nlohmann::json& MemberOf(const nlohmann::json& object, std::string_view name);

// Values of the type that is asked for. Errors: INVALID_ARGUMENT, names `what` and the value.
absl::StatusOr<int64_t> IntegerOf(std::string_view what, const nlohmann::json& value);
absl::StatusOr<double> NumberOf(std::string_view what, const nlohmann::json& value);
absl::StatusOr<std::string> TextOf(std::string_view what, const nlohmann::json& value);
absl::StatusOr<std::vector<int64_t>> IntegersOf(std::string_view what, const nlohmann::json& value);
absl::StatusOr<std::vector<double>> NumbersOf(std::string_view what, const nlohmann::json& value);

// Whether a path that metadata name leads to something below their folder.
bool IsBelowFolder(std::string_view path);

// BadField() of a value of any type.
absl::Status BadValue(std::string_view what, const nlohmann::json& value, std::string_view why);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_JSON_METADATA_H_
