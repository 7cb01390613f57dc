#include "client/export/picture/caption.h"

#include <string_view>
#include <utility>

#include "client/export/text.h"

namespace bccskel::exporting {
namespace {

void AddCount(Text& text, int64_t count, std::string_view one, std::string_view many) {
  text.Add(count, ' ', count == 1 ? one : many);
}

}  // namespace

std::string EscapeMarkup(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

std::string GroupedDigits(uint64_t number) {
  std::string digits = std::to_string(number);
  for (size_t n = digits.size(); n > 3; n -= 3) digits.insert(n - 3, 1, ',');
  return digits;
}

std::string BettiPhrase(const BettiNumbers& betti) {
  Text text;
  AddCount(text, betti.components, "component", "components");
  text.Add(", ");
  AddCount(text, betti.loops, "loop", "loops");
  text.Add(", ");
  AddCount(text, betti.cavities, "cavity", "cavities");
  return std::move(text).Take();
}

std::string ObjectPhrase(const SkeletonizeResult& result) {
  return "object: " + GroupedDigits(result.object_points) + " points, " +
         BettiPhrase(result.certificate.input);
}

std::string SkeletonPhrase(const SkeletonizeResult& result) {
  return "skeleton: " + GroupedDigits(result.skeleton_points) + " points, " +
         BettiPhrase(result.certificate.skeleton) +
         (result.certificate.TopologyKept() ? " (topology kept)" : " (TOPOLOGY NOT KEPT)");
}

}  // namespace bccskel::exporting
