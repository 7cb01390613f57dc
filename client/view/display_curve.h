#ifndef BCCSKEL_CLIENT_VIEW_DISPLAY_CURVE_H_
#define BCCSKEL_CLIENT_VIEW_DISPLAY_CURVE_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/view/result_document.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::view {

// The edges as pages and pictures draw them: their curves, smoother still; one place for each of
// the result's `points`. The first and last place of an edge do not move.
// Errors: those of the context.
absl::StatusOr<std::vector<WorldPoint>> DisplayCurvesOf(const ResultDocument& result,
                                                        const exec::Context& context);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_DISPLAY_CURVE_H_
