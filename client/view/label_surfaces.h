#ifndef BCCSKEL_CLIENT_VIEW_LABEL_SURFACES_H_
#define BCCSKEL_CLIENT_VIEW_LABEL_SURFACES_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "client/view/display_surface.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel::view {

// The objects of labels by their place in a list; called from several threads at once.
using ObjectOfLabel = std::function<absl::StatusOr<std::shared_ptr<const Volume>>(size_t)>;

// The surfaces of many objects as one, in their order. Each object gets triangles in proportion to
// its size to the power of 2/3, but at least a few, so that all together may exceed the budget.
// Units: `sizes`, voxels or points of each object.
// Errors: those of `object` and of MakeDisplaySurface(); RESOURCE_EXHAUSTED.
absl::StatusOr<DisplaySurface> SurfacesOfLabels(const std::vector<uint64_t>& sizes,
                                                const ObjectOfLabel& object, size_t most_triangles,
                                                const exec::Context& context);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_LABEL_SURFACES_H_
