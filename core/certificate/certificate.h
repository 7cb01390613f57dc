#ifndef BCCSKEL_CORE_CERTIFICATE_CERTIFICATE_H_
#define BCCSKEL_CORE_CERTIFICATE_CERTIFICATE_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// Components, loops (tunnels) and cavities: b0, b1, b2.
struct BettiNumbers {
  int64_t components = 0;
  int64_t loops = 0;
  int64_t cavities = 0;

  friend constexpr bool operator==(const BettiNumbers&, const BettiNumbers&) = default;
  constexpr int64_t EulerCharacteristic() const { return components - loops + cavities; }
};

// Euler characteristic of the clique complex: points - adjacent pairs + mutually adjacent triples -
// mutually adjacent quadruples.
int64_t CountEulerCharacteristic(const Volume& object, const exec::Context& context);

// Components by labeling the object, cavities by labeling the background, loops from the Euler
// characteristic. Everything outside the extent is background.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<BettiNumbers> CountBettiNumbers(const Volume& object, const exec::Context& context);

// Points that satisfy Conditions 1 and 2: simple and not an end point.
uint64_t CountSimpleNonEndPoints(const Volume& object, const exec::Context& context);

// The proof that comes with every result.
struct Certificate {
  // Of the cubic mask that the object was made from, counted on the cubic grid, where there is one.
  std::optional<BettiNumbers> mask = std::nullopt;
  BettiNumbers input;
  BettiNumbers skeleton;
  uint64_t simple_points_left = 0;  // simple and not an end point

  bool TopologyKept() const { return input == skeleton; }
  friend bool operator==(const Certificate&, const Certificate&) = default;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_CERTIFICATE_H_
