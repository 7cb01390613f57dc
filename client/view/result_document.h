#ifndef BCCSKEL_CLIENT_VIEW_RESULT_DOCUMENT_H_
#define BCCSKEL_CLIENT_VIEW_RESULT_DOCUMENT_H_

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/lattice/lattice_point.h"
#include "core/prepare/prepare.h"

namespace bccskel::view {

// What pictures show of a JSON result (client/export/skeleton.schema.json). World coordinates.
struct ResultDocument {
  struct Node {
    std::string kind;
    WorldPoint position;
    double radius;
  };
  struct Edge {
    uint64_t source;  // index into nodes
    uint64_t target;
    std::vector<WorldPoint> points;
    std::vector<double> radii;  // one per point
    double length;
  };
  // Points on no edge.
  struct Sheets {
    std::vector<WorldPoint> points;
    std::vector<double> radii;  // one per point
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
  Sheets sheets;
  std::optional<Placement> placement;  // unknown in results of older versions
  PreparingOptions preparing;          // what was done to the object before thinning
  bool border_continues = false;       // then balls reach beyond it
  Certificate certificate;
  uint64_t object_points = 0;
  std::vector<std::pair<std::string, std::string>> options;  // in the document's order
  std::shared_ptr<const nlohmann::json> json;                // the document itself
};

// Errors: INVALID_ARGUMENT with the place of the first thing that is not as the schema says.
// Members that the schema may gain are ignored, and those that it has gained may be missing.
absl::StatusOr<ResultDocument> ParseResultDocument(std::string_view text);

// Errors: those of ParseResultDocument() and of ReadFileBytes(), with the path; RESOURCE_EXHAUSTED
//         for a file above 2 GiB.
absl::StatusOr<ResultDocument> ReadResultDocument(const std::string& path);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RESULT_DOCUMENT_H_
