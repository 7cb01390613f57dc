#include "core/thinning/open_shell.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/open_shell.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

// Planes are not in cache and read in no order, so prefetch them: otherwise the processor waits for
// fewer cache lines at once than it could.
constexpr size_t kAhead = 6;
HWY_INLINE BrickIndex Ahead(std::span<const BrickIndex> bricks, size_t at) {
  return bricks[std::min(at + kAhead, bricks.size() - 1)];
}

// The points whose bit in a plane equals the lowest bit of `number`.
HWY_INLINE Plane WithBit(const Plane& points, const BrickBits& plane, int32_t number) {
  const Plane set = LoadPlane(plane);
  return (number & 1) != 0 ? And(set, points) : AndNot(set, points);
}

void CutShellsTarget(std::span<const ShellPlanes> planes, int32_t first,
                     std::span<const BrickIndex> bricks, BrickBits* points) {
  const size_t count = bricks.size();
  for (size_t at = 0; at < count; ++at) {
    for (const BrickBits& plane : planes[Ahead(bricks, at)]) __builtin_prefetch(&plane, 0, 2);
    const ShellPlanes& own = planes[bricks[at]];
    const Plane one = LoadPlane(own[0]), two = LoadPlane(own[1]);
    // The points of these shells, by the bits that the shells share.
    Plane group = WithBit(Repeat(~uint64_t{0}), own[2], first >> 2);
    for (int b = 3; b < kShellPlanes; ++b) {
      group = WithBit(group, own[static_cast<size_t>(b)], first >> b);
    }
    const Plane low = AndNot(two, group), high = And(two, group);
    StorePlane(AndNot(one, low), points[at]);
    StorePlane(And(one, low), points[count + at]);
    StorePlane(AndNot(one, high), points[2 * count + at]);
    StorePlane(And(one, high), points[3 * count + at]);
  }
}

uint64_t OpenShellTarget(const OpeningView& view, std::span<const BrickIndex> bricks,
                         const BrickBits* points) {
  BrickLane count = hn::Zero(BrickTag());
  for (size_t at = 0; at < bricks.size(); ++at) {
    const BrickIndex n = bricks[at], ahead = Ahead(bricks, at);
    __builtin_prefetch(&view.object[ahead], 0, 2);
    __builtin_prefetch(&view.candidates[ahead], 1, 2);
    Plane opened = And(LoadPlane(points[at]), LoadPlane(view.object[n]));
    if (view.kept != nullptr) opened = AndNot(LoadPlane(view.kept[n]), opened);
    StorePlane(Or(opened, LoadPlane(view.candidates[n])), view.candidates[n]);
    count = PlusBits(count, opened);
    const auto some = static_cast<DirtyMask>(IsEmpty(opened) ? 0 : 0xffff);
    view.enabled[n] |= static_cast<DirtyMask>(view.watched & some);
    view.dirty.Add(n, view.woken & some);
  }
  return TotalOf(count);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(CutShellsTarget);
HWY_EXPORT(OpenShellTarget);

void CutShells(std::span<const ShellPlanes> planes, int32_t first,
               std::span<const BrickIndex> bricks, BrickBits* points) {
  HWY_DYNAMIC_DISPATCH(CutShellsTarget)(planes, first, bricks, points);
}
uint64_t OpenShell(const OpeningView& view, std::span<const BrickIndex> bricks,
                   const BrickBits* points) {
  return HWY_DYNAMIC_DISPATCH(OpenShellTarget)(view, bricks, points);
}

}  // namespace bccskel
#endif  // HWY_ONCE
