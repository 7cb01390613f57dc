#include "client/view/result_document.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/view/document_check.h"
#include "client/view/json_events.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/file_bytes.h"
#include "core/pipeline/option_words.h"

namespace bccskel::view {
namespace {

using Kind = JsonEvent::Kind;

// The path of a value, composed only for an error: documents have millions of values.
struct Place {
  const Place* in = nullptr;  // none: the document
  std::string_view member;    // empty: an item of a list
  size_t item = 0;

  std::string Name() const {
    if (in == nullptr) return "the document";
    if (member.empty()) return absl::StrCat(in->Name(), "[", item, "]");
    return in->in == nullptr ? std::string(member)
                             : absl::StrCat(in->Name(), ".", std::string(member));
  }
};

// A member of an object, and the destination of its value.
template <typename T>
struct Member {
  std::string_view name;
  T& to;
  bool required = false;
  bool found = false;
};
template <typename T>
Member<T> Required(std::string_view name, T& to) {
  return {name, to, true};
}
template <typename T>
Member<T> Optional(std::string_view name, T& to) {
  return {name, to};
}

// A value that is checked but not stored.
struct Unused {};
template <typename T>
struct NotOnPages {
  T& to;
};
template <typename T>
NotOnPages(T&) -> NotOnPages<T>;  // clang 14 needs the guides
// A list of the points of the edge that is read, after those of the edges before it. Not on pages.
template <typename T>
struct OfPoints {
  explicit OfPoints(std::vector<T>& list) : to(list) {}
  std::vector<T>& to;
};
struct Order {
  std::optional<std::vector<uint32_t>>& roots;
  std::string& rule;
};

// Reads values from their events. After the first error the result is incomplete.
class Reader {
 public:
  Reader(ResultDocument& to, const std::stop_token& stop) : to_(to), stop_(stop) {}

  absl::Status Run() && {
    Unused timed, labels;
    NotOnPages timings{timed};
    NotOnPages sheets{to_.sheets};
    Order order{to_.roots, to_.root_rule};
    return ReadDocument(
        Required("nodes", to_.nodes), Required("edges", to_.edges), Optional("sheets", sheets),
        Required("certificate", to_.certificate), Required("object_points", to_.object_points),
        Optional("options", to_), Optional("preparing", to_.steps), Optional("labels", labels),
        Optional("placement", to_.placement), Optional("method", to_.method),
        Optional("algorithm_version", to_.algorithm_version), Optional("world", to_.world),
        Optional("unit", to_.unit), Optional("order", order), Optional("timings", timings));
  }

 private:
  template <typename... T>
  absl::Status ReadDocument(Member<T>... members) {
    const Place document;
    const JsonMembers wanted = {{members.name...}, {"nodes", "edges", "labels"}};
    const auto take = [&](std::string_view name, std::optional<size_t> item,
                          const JsonValue& value) {
      value_ = &value;
      now_ = value.events.data();
      const Place here = {&document, name};
      if (!item.has_value()) {
        ReadMember(name, here, members...);
      } else if (name == "labels") {
        status_ = absl::InvalidArgumentError(
            "holds the skeletons of many labels; have `bccskel labels` write the wanted format, or "
            "take the member \"skeleton\" of one label");
      } else if (name == "nodes") {
        Read({&here, "", *item}, to_.nodes.emplace_back());
      } else {
        Read({&here, "", *item}, to_.edges.emplace_back());
      }
      if (stop_.stop_requested()) status_.Update(absl::CancelledError("interrupted"));
      return status_.ok();
    };
    BCCSKEL_RETURN_IF_ERROR(ReadJson(*to_.text, wanted, take));
    Require(document, members...);
    return std::move(status_);
  }

  void Read(const Place& place, double& to) {
    switch (now_->kind) {
      case Kind::kDouble:
        to = std::bit_cast<double>(now_->bits);
        break;
      case Kind::kUnsigned:
        to = static_cast<double>(now_->bits);
        break;
      case Kind::kNegative:
        to = static_cast<double>(std::bit_cast<int64_t>(now_->bits));
        break;
      default:
        Complain(place, "a finite number");
    }
  }
  template <std::integral Integer>
  void Read(const Place& place, Integer& to) {
    const auto signed_value = std::bit_cast<int64_t>(now_->bits);
    const bool fits = now_->kind == Kind::kUnsigned
                          ? std::in_range<Integer>(now_->bits)
                          : now_->kind == Kind::kNegative && std::in_range<Integer>(signed_value);
    if (!fits) return Complain(place, "an integer in range");
    to = static_cast<Integer>(now_->bits);
  }
  void Read(const Place& place, bool& to) {
    if (now_->kind != Kind::kBool) return Complain(place, "true or false");
    to = now_->bits != 0;
  }
  void Read(const Place& place, std::string& to) {
    if (now_->kind != Kind::kString) return Complain(place, "a string");
    to = Text();
  }
  void Read(const Place& /*place*/, Unused& /*to*/) { Skip(); }
  template <typename T>
  void Read(const Place& place, NotOnPages<T>& to) {
    const JsonEvent& begin = *now_;
    Read(place, to.to);
    if (status_.ok() && &begin != now_) LeaveOut(begin.bits);  // no number or the like
  }
  template <typename T>
  void Read(const Place& place, std::optional<T>& to) {
    Read(place, to.emplace());
  }
  template <typename Item>
  void Read(const Place& place, std::vector<Item>& to) {
    to.clear();
    ReadItems(place, "a list", [&](const Place& at) { Read(at, to.emplace_back()); });
  }
  template <typename Item>
  void Read(const Place& place, OfPoints<Item>& list) {
    const uint64_t begin = now_->bits;
    Fill(list.to, to_.edges.back().first_point);
    ReadItems(place, "a list", [&](const Place& at) { Read(at, list.to.emplace_back()); });
    if (status_.ok()) LeaveOut(begin);
  }
  template <typename Item, size_t kCount>
  void Read(const Place& place, std::array<Item, kCount>& to) {
    size_t count = 0;
    const std::string_view expected = kCount == 3 ? "three numbers" : "a list of nine numbers";
    ReadItems(place, expected, [&](const Place& at) {
      Item beyond;
      Read(at, count < kCount ? to[count] : beyond);
      ++count;
    });
    if (count != kCount) Complain(place, expected);
  }
  void Read(const Place& place, ResultDocument::Node& to) {
    ReadObject(place, Required("kind", to.kind), Required("position", to.position),
               Required("radius", to.radius), Optional("birth", to.birth),
               Optional("loops", to.loops), Optional("cavities", to.cavities));
  }
  void Read(const Place& place, ResultDocument::Edge& to) {
    to.first_point = to_.points.size();
    OfPoints points{to_.points};
    OfPoints radii{to_.radii};
    OfPoints births{to_.births};
    OfPoints shifts{to_.shifts};
    OfPoints curve{to_.curves};
    ReadObject(place, Required("source", to.source), Required("target", to.target),
               Required("points", points), Required("radii", radii), Optional("births", births),
               Optional("shifts", shifts), Optional("curve", curve), Required("length", to.length),
               Optional("pruning_level", to.pruning_level));
    const size_t end = to_.points.size();
    to.point_count = end - to.first_point;
    const bool has_points = to.point_count > 0 && to_.radii.size() == end;
    if (!has_points) Complain(place, "an edge with points and as many radii");
    const auto align = [&](auto& list, std::string_view expected) {
      if (list.size() > to.first_point && list.size() != end) Complain(place, expected);
      if (!list.empty()) Fill(list, end);
    };
    align(to_.births, "an edge with as many births as points");
    align(to_.shifts, "an edge with as many shifts as points");
    align(to_.curves, "an edge with a curve of as many points");
  }
  // Where an edge has no list, its points are its curve, and other values are 0.
  template <typename T>
  void Fill(std::vector<T>& list, size_t size) {
    const size_t known = std::min(list.size(), size);
    list.resize(size);
    if constexpr (std::is_same_v<T, WorldPoint>) {
      for (size_t n = known; n < size; ++n) list[n] = to_.points[n];
    }
  }
  void Read(const Place& place, ResultDocument::Sheets& to) {
    ReadObject(place, Required("points", to.points), Required("radii", to.radii),
               Optional("births", to.births));
    if (to.radii.size() != to.points.size()) Complain(place, "points and as many radii");
    if (!to.births.empty() && to.births.size() != to.points.size()) {
      Complain(place, "a set of sheets with as many births as points");
    }
  }
  void Read(const Place& place, Placement& to) {
    ReadObject(place, Required("spacing", to.spacing), Required("origin", to.origin),
               Required("direction", to.direction));
    if (!status_.ok()) return;
    const absl::Status usable = CheckGrid({1, 1, 1}, to);
    if (!usable.ok()) {
      Complain(place, absl::StrCat("one of a lattice (", usable.message(), ")"));
    }
  }
  void Read(const Place& place, PreparingStep& to) {
    std::string word;
    ReadObject(place, Required("step", word), Optional("count", to.count),
               Optional("points_added", to.points_added),
               Optional("points_removed", to.points_removed));
    for (const auto& [name, kind] : kPreparingWords) {
      if (word == name) return void(to.kind = kind);
    }
    Complain(place, "a step of preparing");
  }
  void Read(const Place& place, BettiNumbers& to) {
    ReadObject(place, Required("components", to.components), Required("loops", to.loops),
               Required("cavities", to.cavities));
  }
  void Read(const Place& place, Certificate& to) {
    ReadObject(place, Required("input", to.input), Required("skeleton", to.skeleton),
               Required("simple_points_left", to.simple_points_left), Optional("mask", to.mask),
               Optional("unprepared", to.unprepared), Optional("sampled", to.sampled));
  }
  // The members of "options".
  void Read(const Place& place, ResultDocument& to) {
    const JsonEvent* const begin = now_;
    to.options.clear();
    ReadFields(place, [&](std::string_view name) { to.options.emplace_back(name, Word()); });
    if (!status_.ok()) return;
    now_ = begin;
    std::string cavities, components;
    PreparingOptions& preparing = to.preparing;
    ReadObject(place, Optional("denoise_passes", preparing.denoise_passes),
               Optional("cavities", cavities), Optional("tunnel_width", preparing.tunnel_width),
               Optional("tunnel_cells", preparing.tunnel_cells),
               Optional("join_gaps", preparing.join_gaps),
               Optional("min_component_points", preparing.min_component_points),
               Optional("min_component_volume", preparing.min_component_volume),
               Optional("components", components));
    if (cavities == "filled") preparing.cavities = CavityFilling::kOn;
    if (components == "largest") preparing.components = KeptComponents::kLargest;
  }
  void Read(const Place& place, Order& to) {
    ReadObject(place, Required("roots", to.roots), Optional("rule", to.rule));
  }

  template <typename... T>
  void ReadObject(const Place& place, Member<T>... members) {
    ReadFields(place, [&](std::string_view name) {
      if (!ReadMember(name, {&place, name}, members...)) Skip();
    });
    Require(place, members...);
  }
  template <typename... T>
  bool ReadMember(std::string_view name, const Place& place, Member<T>&... members) {
    const auto read = [&](auto& member) {
      if (member.name != name) return false;
      member.found = true;
      Read(place, member.to);
      return true;
    };
    return (read(members) || ...);
  }
  template <typename... T>
  void Require(const Place& place, const Member<T>&... members) {
    const auto require = [&](const auto& member) {
      if (member.required && !member.found) Complain({&place, member.name}, "there");
    };
    (require(members), ...);
  }

  template <typename Use>
  void ReadFields(const Place& place, Use use) {
    if (now_->kind != Kind::kBeginObject) return Complain(place, "an object");
    while ((++now_)->kind != Kind::kEndObject) {
      const std::string_view name = Text();
      ++now_;
      use(name);
      if (!status_.ok()) return;
    }
  }
  template <typename Use>
  void ReadItems(const Place& place, std::string_view expected, Use use) {
    if (now_->kind != Kind::kBeginList) return Complain(place, expected);
    for (size_t n = 0; (++now_)->kind != Kind::kEndList; ++n) {
      use(Place{&place, "", n});
      if (!status_.ok()) return;
    }
  }

  // Like every Read(), advances to the last event of the current value.
  void Skip() {
    int64_t open = 0;
    for (;; ++now_) {
      open += now_->kind == Kind::kBeginList || now_->kind == Kind::kBeginObject;
      open -= now_->kind == Kind::kEndList || now_->kind == Kind::kEndObject;
      if (open == 0 && now_->kind != Kind::kName) return;
    }
  }

  // A value as text; a string without its quotes.
  std::string Word() {
    const JsonEvent& begin = *now_;
    switch (begin.kind) {
      case Kind::kString:
        return std::string(Text());
      case Kind::kNull:
        return "null";
      case Kind::kBool:
        return begin.bits != 0 ? "true" : "false";
      case Kind::kDouble:
        return nlohmann::json(std::bit_cast<double>(begin.bits)).dump();
      case Kind::kUnsigned:
        return absl::StrCat(begin.bits);
      case Kind::kNegative:
        return absl::StrCat(std::bit_cast<int64_t>(begin.bits));
      default:
        Skip();
        return to_.text->substr(begin.bits, now_->bits - begin.bits);
    }
  }
  // The value that ends at the current event and begins at this byte is not on pages.
  void LeaveOut(uint64_t begin) {
    to_.not_on_pages.push_back(std::string_view(*to_.text).substr(begin, now_->bits - begin));
  }

  // The text of a string or a name.
  std::string_view Text() const {
    return std::string_view(value_->strings).substr(now_->bits, now_->size);
  }

  void Complain(const Place& place, std::string_view expected) {
    if (!status_.ok()) return;
    status_ = absl::InvalidArgumentError(absl::StrCat(
        "not a JSON result of bccskel: ", place.Name(), " is not ", std::string(expected)));
  }

  ResultDocument& to_;
  const std::stop_token& stop_;
  const JsonValue* value_ = nullptr;
  const JsonEvent* now_ = nullptr;
  absl::Status status_;
};

}  // namespace

absl::StatusOr<ResultDocument> ParseResultDocument(std::string text, const std::stop_token& stop) {
  ResultDocument document;
  document.text = std::make_shared<const std::string>(std::move(text));
  BCCSKEL_RETURN_IF_ERROR(Reader(document, stop).Run());
  BCCSKEL_RETURN_IF_ERROR(CheckDocument(document));
  return document;
}

absl::StatusOr<ResultDocument> ReadResultDocument(const std::string& path,
                                                  const std::stop_token& stop) {
  constexpr uint64_t kMostBytes = uint64_t{1} << 31;
  BCCSKEL_ASSIGN_OR_RETURN(std::string text, ReadFileBytes(path, kMostBytes));
  absl::StatusOr<ResultDocument> document = ParseResultDocument(std::move(text), stop);
  if (document.ok()) return document;
  return absl::Status(document.status().code(),
                      absl::StrCat(path, ": ", document.status().message()));
}

}  // namespace bccskel::view
