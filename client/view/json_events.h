#ifndef BCCSKEL_CLIENT_VIEW_JSON_EVENTS_H_
#define BCCSKEL_CLIENT_VIEW_JSON_EVENTS_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"

namespace bccskel::view {

// What stands next in a JSON value.
struct JsonEvent {
  enum class Kind : uint8_t {
    kNull,
    kBool,
    kUnsigned,  // an integer
    kNegative,  // an integer
    kDouble,
    kString,
    kName,  // of a member; its value is next
    kBeginList,
    kEndList,
    kBeginObject,
    kEndObject,
  };
  Kind kind;
  // By kind: the number's bits, where a string begins in JsonValue::strings, or the place in the
  // text: of the bracket that begins, behind the one that ends.
  uint64_t bits = 0;
  uint64_t size = 0;  // of a string
};

// One value: a number is one event, a list is those of its items between two more.
struct JsonValue {
  std::vector<JsonEvent> events;
  std::string strings;
};

// Members of a document that is an object.
struct JsonMembers {
  std::vector<std::string_view> whole;
  std::vector<std::string_view> by_item;  // if they are lists: an empty one, then item by item
};

// False: no more. The item's index is none for a whole member.
using TakeJson =
    std::function<bool(std::string_view member, std::optional<size_t> item, const JsonValue&)>;

// Hands out values as they stand in the text, all of which is checked: documents are larger than
// trees of them should be. Errors: INVALID_ARGUMENT for what is not JSON, or not an object.
absl::Status ReadJson(std::string_view text, const JsonMembers& wanted, const TakeJson& take);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_JSON_EVENTS_H_
