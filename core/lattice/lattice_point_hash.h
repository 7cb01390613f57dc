#ifndef BCCSKEL_CORE_LATTICE_LATTICE_POINT_HASH_H_
#define BCCSKEL_CORE_LATTICE_LATTICE_POINT_HASH_H_

#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace bccskel {

struct LatticePointHash {
  size_t operator()(LatticePoint p) const {
    const auto part = [](int32_t v) { return static_cast<uint64_t>(static_cast<uint32_t>(v)); };
    uint64_t hash = part(p.x) * 0x9e3779b97f4a7c15u + part(p.y) * 0xc2b2ae3d27d4eb4fu;
    hash = (hash ^ hash >> 29) + part(p.z) * 0x165667b19e3779f9u;
    return static_cast<size_t>((hash ^ hash >> 32) * 0xd6e8feb86659fd93u);
  }
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LATTICE_LATTICE_POINT_HASH_H_
