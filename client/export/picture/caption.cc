#include "client/export/picture/caption.h"

namespace bccskel::exporting {

std::string GroupedDigits(uint64_t number) {
  std::string digits = std::to_string(number);
  for (size_t n = digits.size(); n > 3; n -= 3) digits.insert(n - 3, 1, ',');
  return digits;
}

std::string Counted(uint64_t count, std::string_view one, std::string_view many) {
  return GroupedDigits(count) + ' ' + std::string(count == 1 ? one : many);
}

std::string BettiPhrase(const BettiNumbers& betti) {
  const auto counted = [](int64_t count, const char* one, const char* many) {
    return Counted(static_cast<uint64_t>(count), one, many);
  };
  return counted(betti.components, "component", "components") + ", " +
         counted(betti.loops, "loop", "loops") + ", " +
         counted(betti.cavities, "cavity", "cavities");
}

std::string ObjectPhrase(const view::ResultDocument& result) {
  const std::string objects = result.labels.has_value()
                                  ? Counted(result.labels->names.size(), "label", "labels")
                                  : "object";
  return objects + ": " + Counted(result.object_points, "point", "points") + ", " +
         BettiPhrase(result.certificate.input);
}

std::string SkeletonPhrase(const view::ResultFacts& result, const std::string& size) {
  return "skeleton: " + size + ", " + BettiPhrase(result.certificate.skeleton);
}

std::string UnitBehind(const view::ResultFacts& result) {
  if (result.unit.empty() || result.unit == "unknown") return "";
  return result.unit == "um" ? " \u00b5m" : " " + result.unit;
}

}  // namespace bccskel::exporting
