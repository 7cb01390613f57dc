#ifndef BCCSKEL_CORE_IO_EXR_ATTRIBUTES_H_
#define BCCSKEL_CORE_IO_EXR_ATTRIBUTES_H_

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/io/little_endian.h"

namespace bccskel {

enum class ExrAttributeNeed { kRequired, kOptional };

// An attribute that the profile knows. `bytes` is nullopt where the length varies.
struct ExrAttributeRule {
  std::string_view name;
  std::string_view type;
  std::optional<size_t> bytes;
  ExrAttributeNeed need = ExrAttributeNeed::kRequired;
};

// Every attribute that a part may have.
inline constexpr std::array<ExrAttributeRule, 17> kExrAttributeRules = {{
    {"bccBricks", "int", 4, ExrAttributeNeed::kOptional},
    {"bccDirection", "m33d", 72},
    {"bccExtent", "v3i", 12},
    {"bccOrigin", "v3d", 24},
    {"bccProfile", "int", 4},
    {"bccSpacing", "v3d", 24},
    {"channels", "chlist", std::nullopt},
    {"chunkCount", "int", 4},
    {"compression", "compression", 1},
    {"dataWindow", "box2i", 16},
    {"displayWindow", "box2i", 16},
    {"lineOrder", "lineOrder", 1},
    {"name", "string", std::nullopt},
    {"pixelAspectRatio", "float", 4},
    {"screenWindowCenter", "v2f", 8},
    {"screenWindowWidth", "float", 4},
    {"type", "string", std::nullopt},
}};

// The attributes of one part, as bytes of the header; it must outlive them.
class ExrAttributes {
 public:
  // Reads up to and including the empty name that ends a part's header.
  // Errors: INVALID_ARGUMENT for anything that is not exactly the attributes of the rules.
  static absl::StatusOr<ExrAttributes> Read(ByteCursor& cursor);

  bool Has(std::string_view name) const { return Find(name).has_value(); }
  // Needs: the attribute is there.
  std::span<const std::byte> Value(std::string_view name) const { return *Find(name); }
  std::string_view Text(std::string_view name) const {
    const auto value = Value(name);
    return {reinterpret_cast<const char*>(value.data()), value.size()};
  }
  template <typename Number>
  Number NumberAt(std::string_view name, size_t index) const {
    return LoadNumber<Number>(Value(name), index * sizeof(Number));
  }

 private:
  std::optional<std::span<const std::byte>> Find(std::string_view name) const;
  absl::Status CheckComplete() const;

  std::array<std::optional<std::span<const std::byte>>, kExrAttributeRules.size()> values_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_ATTRIBUTES_H_
