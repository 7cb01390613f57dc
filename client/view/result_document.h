#ifndef BCCSKEL_CLIENT_VIEW_RESULT_DOCUMENT_H_
#define BCCSKEL_CLIENT_VIEW_RESULT_DOCUMENT_H_

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/lattice/lattice_point.h"
#include "core/prepare/prepare.h"

namespace bccskel::view {

// What a result is of, and how it was made.
struct ResultFacts {
  std::string method = "unknown";
  std::string algorithm_version = "unknown";
  std::string world = "unknown";
  std::string unit = "unknown";
  std::vector<std::pair<std::string, std::string>> options;  // in the document's order
  std::vector<PreparingStep> steps;                          // before thinning, with their effects
  Certificate certificate;
  uint64_t object_points = 0;  // after preparing
};

// A JSON result (client/export/skeleton.schema.json). World coordinates.
struct ResultDocument : ResultFacts {
  struct Node {
    std::string kind;
    WorldPoint position;
    double radius;
    int32_t birth = 0;
    uint32_t loops = 0;
    uint32_t cavities = 0;
  };
  struct Edge {
    uint64_t source;  // index into nodes
    uint64_t target;
    size_t first_point;  // in `points` and the lists like it
    size_t point_count;
    double length;
    double pruning_level = std::numeric_limits<double>::infinity();
  };
  // Points on no edge.
  struct Sheets {
    std::vector<WorldPoint> points;
    std::vector<double> radii;    // one per point
    std::vector<int32_t> births;  // one per point, or none
  };
  // Of the skeletons of many labels side by side.
  struct Labels {
    std::vector<uint64_t> names;      // each label once, ascending, also without nodes
    std::vector<uint32_t> of_nodes;   // index into names, one per node
    std::vector<uint32_t> of_sheets;  // the same per point of the sheets
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
  // Of the points of all edges, one edge after the other; the last three may be empty.
  std::vector<WorldPoint> points;
  std::vector<double> radii;
  std::vector<int32_t> births;
  std::vector<std::array<int16_t, 3>> shifts;
  std::vector<WorldPoint> curves;  // the smooth curves; older versions have none
  Sheets sheets;
  std::optional<Labels> labels;                // no document states them
  std::optional<Placement> placement;          // unknown in results of older versions
  PreparingOptions preparing;                  // the preparation of the object before thinning
  std::optional<std::vector<uint32_t>> roots;  // of a result with an order; indices into nodes
  std::string root_rule;                       // the rule of the roots, if the document states it
  std::shared_ptr<const std::string> text;     // the document itself
  // Values of the document, in order, that a page lacks or holds in another form: timings, sheets,
  // and the lists of points of edges.
  std::vector<std::string_view> not_on_pages;

  std::span<const WorldPoint> PointsOf(const Edge& edge) const {
    return std::span(points).subspan(edge.first_point, edge.point_count);
  }
  std::span<const double> RadiiOf(const Edge& edge) const {
    return std::span(radii).subspan(edge.first_point, edge.point_count);
  }
};

// Errors: INVALID_ARGUMENT with the position of the first violation of the schema. Unknown members
//         are ignored, and members that later versions of the schema added may be missing;
//         CANCELLED after a stop request.
absl::StatusOr<ResultDocument> ParseResultDocument(std::string text,
                                                   const std::stop_token& stop = {});

// Errors: those of ParseResultDocument() and of ReadFileBytes(), with the path; RESOURCE_EXHAUSTED
//         for a file above 2 GiB.
absl::StatusOr<ResultDocument> ReadResultDocument(const std::string& path,
                                                  const std::stop_token& stop = {});

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RESULT_DOCUMENT_H_
