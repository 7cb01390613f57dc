#ifndef BCCSKEL_CORE_PREPARE_KEEP_COMPONENTS_H_
#define BCCSKEL_CORE_PREPARE_KEEP_COMPONENTS_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/prepare/changed_volume.h"

namespace bccskel {

// Drops the components with fewer than `least` points; counts them.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> DropSmallComponents(const Volume& object, uint64_t least,
                                                  const exec::Context& context);

// Drops all components except the one with the most points; on ties the one with the first point in
// the order of Volume::ForEachPoint() stays. Counts the dropped ones.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> KeepLargestComponent(const Volume& object,
                                                   const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_KEEP_COMPONENTS_H_
