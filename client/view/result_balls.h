#ifndef BCCSKEL_CLIENT_VIEW_RESULT_BALLS_H_
#define BCCSKEL_CLIENT_VIEW_RESULT_BALLS_H_

#include <vector>

#include "client/view/result_document.h"
#include "core/export/reconstruct/union_of_balls.h"

namespace bccskel::view {

// A ball around every point of a result: the same as BallsOf() its graph, on the lattice of
// `placement`.
std::vector<OpenBall> BallsOf(const ResultDocument& result, const Placement& placement);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_RESULT_BALLS_H_
