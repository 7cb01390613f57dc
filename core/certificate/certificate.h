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
  constexpr BettiNumbers& operator+=(const BettiNumbers& other) {
    components += other.components;
    loops += other.loops;
    cavities += other.cavities;
    return *this;
  }
  constexpr int64_t EulerCharacteristic() const { return components - loops + cavities; }
};

// Euler characteristic of the clique complex: points - adjacent pairs + mutually adjacent triples -
// mutually adjacent quadruples.
int64_t CountEulerCharacteristic(const Volume& object, const exec::Context& context);

// Components by labeling the object, cavities by labeling the background, loops from the Euler
// characteristic. Everything outside the extent is background.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<BettiNumbers> CountBettiNumbers(const Volume& object, const exec::Context& context);

// Which simple points (Condition 1) to count: all, or those that are not end points (Condition 2).
enum class SimplePoints : uint8_t { kAll, kNonEnd };

// The number of these points that are not in `spared`.
uint64_t CountSimplePoints(const Volume& object, SimplePoints which, const Volume& spared,
                           const exec::Context& context);

// The topology before and after thinning; part of every result.
struct Certificate {
  // Of the cubic mask from which the object was made, if any, counted on the cubic grid.
  std::optional<BettiNumbers> mask = std::nullopt;
  // Of the object before it was prepared for thinning, if it was.
  std::optional<BettiNumbers> unprepared = std::nullopt;
  BettiNumbers input;  // of the object that was thinned
  BettiNumbers skeleton;
  // Simple points that this kind of skeleton would still remove; 0 if thinning was completed.
  uint64_t simple_points_left = 0;
  // Whether the object is a sampling of the mask, which may have changed the topology, rather than
  // an exact conversion.
  bool sampled = false;

  // The numbers of the object as it was given.
  const BettiNumbers& Given() const { return unprepared.has_value() ? *unprepared : input; }
  // Sums over objects side by side, such as the labels of an image. An object that was not prepared
  // counts with its input where others were.
  Certificate& operator+=(const Certificate& other) {
    if (other.mask.has_value()) mask = mask.value_or(BettiNumbers()) += *other.mask;
    if (unprepared.has_value() || other.unprepared.has_value()) {
      unprepared = BettiNumbers(Given()) += other.Given();
    }
    input += other.input;
    skeleton += other.skeleton;
    simple_points_left += other.simple_points_left;
    sampled |= other.sampled;
    return *this;
  }
  bool TopologyKept() const { return input == skeleton; }
  // Whether the object has the numbers of its mask, if it has one.
  bool MaskKept() const { return !mask.has_value() || *mask == Given(); }
  friend bool operator==(const Certificate&, const Certificate&) = default;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_CERTIFICATE_H_
