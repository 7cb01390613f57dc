#ifndef BCCSKEL_CORE_CERTIFICATE_EULER_CHARACTERISTIC_H_
#define BCCSKEL_CORE_CERTIFICATE_EULER_CHARACTERISTIC_H_

#include <cstdint>
#include <span>

#include "core/exec/context.h"
#include "core/volume/brick_neighbors.h"
#include "core/volume/volume.h"

namespace bccskel {

// Like CountEulerCharacteristic(object, context) for neighbors that are known already.
// Shapes: one neighborhood per brick of the object.
int64_t CountEulerCharacteristic(const Volume& object, std::span<const BrickNeighborhood> neighbors,
                                 const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_EULER_CHARACTERISTIC_H_
