#ifndef BCCSKEL_CORE_PRUNING_GROW_ALONG_H_
#define BCCSKEL_CORE_PRUNING_GROW_ALONG_H_

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Replaces the points of a branch after position `from` of its path by points along the places, if
// these points reach the last place. Each new point touches the set only at the point before it, so
// the topology stays and the curve is thin. New points have the radius 0. Returns whether it did;
// otherwise nothing changes.
// Needs: the path ends at an end of `set`; at least one place, the first beside path[from].
bool GrowAlong(std::span<const Coordinates> places, size_t from,
               const std::function<bool(LatticePoint)>& may_add, std::vector<LatticePoint>& path,
               ThinSet& set);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_GROW_ALONG_H_
