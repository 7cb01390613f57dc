#include "client/view/result_document.h"

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/file_bytes.h"

namespace bccskel::view {
namespace {

using Json = nlohmann::json;

// Where a value stands, composed only for an error: documents have millions of values.
struct Place {
  const Place* in = nullptr;  // none: the document
  std::string_view member;    // empty: an item of a list
  size_t item = 0;

  std::string Name() const {
    if (in == nullptr) return "";
    if (member.empty()) return absl::StrCat(in->Name(), "[", item, "]");
    return in->in == nullptr ? std::string(member)
                             : absl::StrCat(in->Name(), ".", std::string(member));
  }
};

// Reads members of a document. After the first error all that is read is empty.
class Reader {
 public:
  const absl::Status& status() const { return status_; }

  void Read(const Json& from, const Place& place, double& to) {
    if (!from.is_number() || !std::isfinite(from.get<double>())) {
      return Complain(place, "a finite number");
    }
    to = from.get<double>();
  }
  template <std::integral Integer>
  void Read(const Json& from, const Place& place, Integer& to) {
    const bool negative = from.is_number_integer() && !from.is_number_unsigned();
    if (!from.is_number_integer() || (negative && std::unsigned_integral<Integer>)) {
      return Complain(place, "an integer in range");
    }
    to = from.get<Integer>();
  }
  void Read(const Json& from, const Place& place, std::string& to) {
    if (!from.is_string()) return Complain(place, "a string");
    to = from.get<std::string>();
  }
  template <typename Item>
  void Read(const Json& from, const Place& place, std::vector<Item>& to) {
    if (!from.is_array()) return Complain(place, "a list");
    to.resize(from.size());
    for (size_t n = 0; n < to.size() && status_.ok(); ++n) {
      Read(from[n], {&place, "", n}, to[n]);
    }
  }
  void Read(const Json& from, const Place& place, ResultDocument::Node& to) {
    ReadMember(from, place, "kind", to.kind);
    ReadMember(from, place, "position", to.position);
    ReadMember(from, place, "radius", to.radius);
  }
  void Read(const Json& from, const Place& place, ResultDocument::Edge& to) {
    ReadMember(from, place, "source", to.source);
    ReadMember(from, place, "target", to.target);
    ReadMember(from, place, "points", to.points);
    ReadMember(from, place, "radii", to.radii);
    ReadMember(from, place, "length", to.length);
    if (to.points.empty() || to.radii.size() != to.points.size()) {
      Complain(place, "an edge with points and as many radii");
    }
  }
  void Read(const Json& from, const Place& place, ResultDocument::Sheets& to) {
    ReadMember(from, place, "points", to.points);
    ReadMember(from, place, "radii", to.radii);
    if (to.radii.size() != to.points.size()) Complain(place, "points and as many radii");
  }
  template <size_t kCount>
  void Read(const Json& from, const Place& place, std::array<double, kCount>& to) {
    if (!from.is_array() || from.size() != kCount) {
      return Complain(place, kCount == 3 ? "three numbers" : absl::StrCat(kCount, " numbers"));
    }
    for (size_t n = 0; n < kCount; ++n) Read(from[n], place, to[n]);
  }
  void Read(const Json& from, const Place& place, Placement& to) {
    ReadMember(from, place, "spacing", to.spacing);
    ReadMember(from, place, "origin", to.origin);
    ReadMember(from, place, "direction", to.direction);
    const absl::Status usable = status_.ok() ? CheckGrid({1, 1, 1}, to) : absl::OkStatus();
    if (!usable.ok()) Complain(place, "one of a lattice (" + std::string(usable.message()) + ")");
  }
  void Read(const Json& from, const Place& place, PreparingOptions& to) {
    if (!from.is_object()) return Complain(place, "an object");
    std::string cavities, components;
    ReadIfThere(from, "denoise_passes", to.denoise_passes);
    ReadIfThere(from, "cavities", cavities);
    ReadIfThere(from, "tunnel_width", to.tunnel_width);
    ReadIfThere(from, "tunnel_cells", to.tunnel_cells);
    ReadIfThere(from, "min_component_points", to.min_component_points);
    ReadIfThere(from, "min_component_volume", to.min_component_volume);
    ReadIfThere(from, "components", components);
    if (cavities == "filled") to.cavities = CavityFilling::kOn;
    if (components == "largest") to.components = KeptComponents::kLargest;
  }
  void Read(const Json& from, const Place& place, BettiNumbers& to) {
    ReadMember(from, place, "components", to.components);
    ReadMember(from, place, "loops", to.loops);
    ReadMember(from, place, "cavities", to.cavities);
  }
  void Read(const Json& from, const Place& place, Certificate& to) {
    ReadMember(from, place, "input", to.input);
    ReadMember(from, place, "skeleton", to.skeleton);
    ReadMember(from, place, "simple_points_left", to.simple_points_left);
    if (!status_.ok()) return;
    if (from.contains("mask")) ReadMember(from, place, "mask", to.mask.emplace());
    if (from.contains("unprepared")) {
      ReadMember(from, place, "unprepared", to.unprepared.emplace());
    }
    to.sampled = from.is_object() && from.value("sampled", Json()) == true;
  }
  template <typename T>
  void ReadMember(const Json& from, const Place& place, const char* name, T& to) {
    const Place here = {&place, name};
    const auto member = from.is_object() ? from.find(name) : from.end();
    if (member == from.end()) return Complain(here, "there");
    Read(*member, here, to);
  }

  // Leaves `to` as it is where there is no such member. Needs: an object.
  template <typename T>
  void ReadIfThere(const Json& from, const char* name, T& to) {
    const auto member = from.find(name);
    if (member != from.end()) Read(*member, {&kDocument, name}, to);
  }

  void Complain(const Place& place, const std::string& expected) {
    if (!status_.ok()) return;
    status_ = absl::InvalidArgumentError(
        absl::StrCat("no JSON result of bccskel: ", place.Name(), " is not ", expected));
  }

 private:
  static constexpr Place kDocument = {};
  absl::Status status_;
};

absl::Status CheckEdges(const ResultDocument& document) {
  for (const ResultDocument::Edge& edge : document.edges) {
    const uint64_t last = std::max(edge.source, edge.target);
    if (last < document.nodes.size()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("an edge names node ", last, "; there are ", document.nodes.size(), " nodes"));
  }
  return absl::OkStatus();
}

// In the order in which they stand, which Json forgets. (Objects of ordered_json copy their members
// whenever they grow: a whole document takes three times as long.)
std::vector<std::pair<std::string, std::string>> OptionsIn(std::string_view text) {
  using OrderedJson = nlohmann::ordered_json;
  const auto only_options = [](int depth, Json::parse_event_t event, OrderedJson& parsed) {
    return depth != 1 || event != Json::parse_event_t::key || parsed == "options";
  };
  const OrderedJson json = OrderedJson::parse(text, only_options, /*allow_exceptions=*/false);
  std::vector<std::pair<std::string, std::string>> options;
  if (!json.is_object() || !json.contains("options")) return options;
  for (const auto& [name, value] : json["options"].items()) {
    options.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return options;
}

}  // namespace

absl::StatusOr<ResultDocument> ParseResultDocument(std::string_view text) {
  ResultDocument document;
  document.json =
      std::make_shared<const Json>(Json::parse(text, nullptr, /*allow_exceptions=*/false));
  const Json& json = *document.json;
  if (json.is_discarded())
    return absl::InvalidArgumentError("not a JSON result of skeletonize or submit");
  Reader reader;
  reader.ReadMember(json, {}, "nodes", document.nodes);
  reader.ReadMember(json, {}, "edges", document.edges);
  reader.ReadMember(json, {}, "certificate", document.certificate);
  reader.ReadMember(json, {}, "object_points", document.object_points);
  BCCSKEL_RETURN_IF_ERROR(reader.status());
  reader.ReadIfThere(json, "sheets", document.sheets);
  reader.ReadIfThere(json, "options", document.preparing);
  BCCSKEL_RETURN_IF_ERROR(reader.status());
  if (json.contains("options")) {
    document.border_continues = json["options"].value("border", Json()) == "continues";
  }
  if (json.contains("placement")) {
    reader.ReadMember(json, {}, "placement", document.placement.emplace());
  }
  BCCSKEL_RETURN_IF_ERROR(reader.status());
  BCCSKEL_RETURN_IF_ERROR(CheckEdges(document));
  document.options = OptionsIn(text);
  return document;
}

absl::StatusOr<ResultDocument> ReadResultDocument(const std::string& path) {
  constexpr uint64_t kMostBytes = uint64_t{1} << 31;
  BCCSKEL_ASSIGN_OR_RETURN(const std::string text, ReadFileBytes(path, kMostBytes));
  absl::StatusOr<ResultDocument> document = ParseResultDocument(text);
  if (document.ok()) return document;
  return absl::Status(document.status().code(),
                      absl::StrCat(path, ": ", document.status().message()));
}

}  // namespace bccskel::view
