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

// The next token of a JSON value.
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
  // By kind: the bits of the number; the position of the string in JsonValue::strings; or the
  // position in the text, at an opening bracket and after a closing one.
  uint64_t bits = 0;
  uint64_t size = 0;  // of a string
};

// One value: one event for a number; a list has those of its items between two more.
struct JsonValue {
  std::vector<JsonEvent> events;
  std::string strings;
};

// The requested members of a document that is an object.
struct JsonMembers {
  std::vector<std::string_view> whole;
  std::vector<std::string_view> by_item;  // lists: an empty one first, then each item
};

// Returns false to stop. `item` is the item's index; none for a whole member.
using TakeJson =
    std::function<bool(std::string_view member, std::optional<size_t> item, const JsonValue&)>;

// Passes on values in the order of the text, all of which is checked. Builds no tree, because
// documents are large.
// Errors: INVALID_ARGUMENT for text that is not JSON or not an object.
absl::Status ReadJson(std::string_view text, const JsonMembers& wanted, const TakeJson& take);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_JSON_EVENTS_H_
