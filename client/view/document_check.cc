#include "client/view/document_check.h"

#include <algorithm>
#include <span>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

absl::Status CheckIndices(const ResultDocument& document) {
  const auto check = [&](const char* what, uint64_t node) {
    if (node < document.nodes.size()) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat(what, " names node ", node, "; there are ", document.nodes.size(), " nodes"));
  };
  for (const ResultDocument::Edge& edge : document.edges) {
    BCCSKEL_RETURN_IF_ERROR(check("an edge", std::max(edge.source, edge.target)));
  }
  if (document.roots.has_value()) {
    for (const uint32_t root : *document.roots) BCCSKEL_RETURN_IF_ERROR(check("the order", root));
  }
  return absl::OkStatus();
}

absl::Status CheckRadius(const std::string& place, double radius) {
  if (radius >= 0) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("not a JSON result of bccskel: ", place, " is ", radius, ", below 0"));
}

absl::Status CheckRadiiOf(const std::string& owner, std::span<const double> radii) {
  const auto negative = std::ranges::find_if(radii, [](double radius) { return !(radius >= 0); });
  if (negative == radii.end()) return absl::OkStatus();
  return CheckRadius(absl::StrCat(owner, ".radii[", negative - radii.begin(), "]"), *negative);
}

absl::Status CheckRadii(const ResultDocument& document) {
  for (size_t n = 0; n < document.nodes.size(); ++n) {
    if (document.nodes[n].radius >= 0) continue;
    return CheckRadius(absl::StrCat("nodes[", n, "].radius"), document.nodes[n].radius);
  }
  for (size_t n = 0; n < document.edges.size(); ++n) {
    BCCSKEL_RETURN_IF_ERROR(
        CheckRadiiOf(absl::StrCat("edges[", n, "]"), document.RadiiOf(document.edges[n])));
  }
  return CheckRadiiOf("sheets", document.sheets.radii);
}

}  // namespace

absl::Status CheckDocument(const ResultDocument& document) {
  BCCSKEL_RETURN_IF_ERROR(CheckIndices(document));
  return CheckRadii(document);
}

}  // namespace bccskel::view
