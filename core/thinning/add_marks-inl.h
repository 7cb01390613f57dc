// How kernels return the points that they mark in a brick. Include it inside a Highway
// foreach_target source.

#include <cstddef>
#include <vector>

#include "core/thinning/mark_removable.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"

#if defined(BCCSKEL_CORE_THINNING_ADD_MARKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BCCSKEL_CORE_THINNING_ADD_MARKS_INL_H_
#undef BCCSKEL_CORE_THINNING_ADD_MARKS_INL_H_
#else
#define BCCSKEL_CORE_THINNING_ADD_MARKS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

// Appends the points as marks if there are any. Always writes and then advances by the result of a
// comparison: a branch that is often taken would be mispredicted too often.
HWY_INLINE void Append(const Plane& marks, BrickIndex brick, MarkedBrick* marked, size_t& count) {
  StorePlane(marks, marked[count].marks);
  marked[count].brick = brick;
  count += IsEmpty(marks) ? 0 : 1;
}

// The same for marks that are rare.
HWY_INLINE void AddIfAny(const Plane& marks, BrickIndex brick, std::vector<MarkedBrick>& marked) {
  if (IsEmpty(marks)) return;
  marked.push_back({{}, brick});
  StorePlane(marks, marked.back().marks);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
