#include "client/view/json_events.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <nlohmann/json.hpp>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace bccskel::view {
namespace {

using Json = nlohmann::json;
using Kind = JsonEvent::Kind;

// Characters that track the parser's position.
class TrackedChars {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  TrackedChars(const char* at, const char** now) : at_(at), now_(now) {}

  reference operator*() const { return *at_; }
  TrackedChars& operator++() {
    *now_ = ++at_;
    return *this;
  }
  TrackedChars operator++(int) {
    TrackedChars before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const TrackedChars& a, const TrackedChars& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  const char** now_;
};

// The parser quotes what it read, which may be no text.
std::string InAscii(std::string_view text) {
  std::string ascii;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x80) {
      ascii += c;
    } else {
      absl::StrAppend(&ascii, "\\x", absl::Hex(static_cast<unsigned char>(c)));
    }
  }
  return ascii;
}

// What is wrong with the first character of what should be an object; empty: nothing.
std::string WrongBeginning(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // the parser skips it, too
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (text.starts_with('{')) return "";
  return absl::StrCat(text.empty() ? "it is empty"
                                   : absl::StrCat("it begins with '",
                                                  absl::CHexEscape(std::string(text.substr(0, 1))),
                                                  "', not with '{'"),
                      "; `bccskel skeletonize` writes one with -o result.json");
}

// The callbacks of nlohmann's parser, in its spelling; false stops it.
class Handler {
 public:
  Handler(std::string_view text, const JsonMembers& wanted, const TakeJson& take)
      : text_(text), now_(text.data()), wanted_(wanted), take_(take) {}

  absl::Status Run() && {
    if (const std::string wrong = WrongBeginning(text_); !wrong.empty()) {
      Fail(wrong);
      return status_;
    }
    const TrackedChars begin(text_.data(), &now_), end(text_.data() + text_.size(), &now_);
    Json::sax_parse(begin, end, this);
    return status_;
  }

  bool null() { return Add({Kind::kNull}); }
  bool boolean(bool value) { return Add({Kind::kBool, value}); }
  bool number_unsigned(uint64_t value) { return Add({Kind::kUnsigned, value}); }
  bool number_integer(int64_t value) {
    return Add({Kind::kNegative, std::bit_cast<uint64_t>(value)});
  }
  bool number_float(double value, const std::string& /*text*/) {
    return Add({Kind::kDouble, std::bit_cast<uint64_t>(value)});
  }
  bool string(const std::string& value) { return AddString(Kind::kString, value); }
  bool binary(const std::vector<uint8_t>& /*value*/) { return false; }  // not in JSON
  bool start_array(size_t /*size*/) {
    if (depth_ == 1 && by_item_) {
      ++depth_;
      item_ = 0;
      value_ = {{{Kind::kBeginList}, {Kind::kEndList}}, {}};
      return Take(std::nullopt);
    }
    return Begin(Kind::kBeginList);
  }
  bool end_array() {
    if (depth_ == 2 && item_.has_value()) {
      --depth_;
      item_.reset();
      return true;
    }
    return End(Kind::kEndList);
  }
  bool start_object(size_t /*size*/) {
    return depth_ == 0 ? ++depth_ > 0 : Begin(Kind::kBeginObject);
  }
  bool end_object() { return depth_ == 1 ? --depth_ == 0 : End(Kind::kEndObject); }
  bool key(const std::string& name) {
    if (depth_ > 1) return AddString(Kind::kName, name);
    member_ = name;
    by_item_ = std::ranges::count(wanted_.by_item, name) > 0;
    wanted_now_ = by_item_ || std::ranges::count(wanted_.whole, name) > 0;
    return true;
  }
  bool parse_error(size_t at, const std::string& /*token*/, const std::exception& error) {
    if (at > text_.size()) {
      status_ = absl::InvalidArgumentError(
          absl::StrCat("is incomplete: it breaks off after ", text_.size(),
                       " bytes; copy it again, or make it again with `bccskel skeletonize`"));
      return false;
    }
    std::string_view why = error.what();  // "[json.exception.parse_error.101] parse error at ..."
    why.remove_prefix(std::min(why.find("] ") + 2, why.size()));
    return Fail(absl::StrCat("byte ", at, ": ", InAscii(why)));
  }

 private:
  int ItemDepth() const { return item_.has_value() ? 2 : 1; }

  bool Begin(Kind kind) {
    ++depth_;
    if (wanted_now_) value_.events.push_back({kind, Offset() - 1});
    return true;
  }
  bool End(Kind kind) {
    --depth_;
    return Add({kind, Offset()});
  }
  bool AddString(Kind kind, const std::string& text) {
    if (!wanted_now_ && depth_ > 0) return true;
    const uint64_t begin = value_.strings.size();
    value_.strings += text;
    return Add({kind, begin, text.size()});
  }
  bool Add(const JsonEvent& event) {
    if (!wanted_now_) return true;
    value_.events.push_back(event);
    if (depth_ > ItemDepth() || event.kind == Kind::kName) return true;
    const std::optional<size_t> item = item_;
    if (item_.has_value()) ++*item_;
    return Take(item);
  }
  bool Take(std::optional<size_t> item) {
    const bool more = take_(member_, item, value_);
    value_.events.clear();
    value_.strings.clear();
    return more;
  }
  bool Fail(const std::string& why) {
    status_ = absl::InvalidArgumentError("not a JSON result of skeletonize or submit: " + why);
    return false;
  }
  uint64_t Offset() const { return static_cast<uint64_t>(now_ - text_.data()); }

  const std::string_view text_;
  const char* now_;
  const JsonMembers& wanted_;
  const TakeJson& take_;
  absl::Status status_;
  int64_t depth_ = 0;  // of open brackets
  std::string member_;
  bool by_item_ = false;
  bool wanted_now_ = false;
  std::optional<size_t> item_;  // of a list that is read by item
  JsonValue value_;
};

}  // namespace

absl::Status ReadJson(std::string_view text, const JsonMembers& wanted, const TakeJson& take) {
  return Handler(text, wanted, take).Run();
}

}  // namespace bccskel::view
