#ifndef BCCSKEL_PROTO_WIRE_ENUMERATORS_H_
#define BCCSKEL_PROTO_WIRE_ENUMERATORS_H_

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

// Both read a table of the interface's enumerators and what each means to us. An enumerator that
// the table does not have is one of a newer version.

namespace bccskel::wire {

template <typename Enumerator, typename Meaning, size_t kCount>
std::optional<Meaning> MeaningOf(Enumerator wanted,
                                 const std::pair<Enumerator, Meaning> (&known)[kCount]) {
  const auto* const found =
      std::ranges::find(known, wanted, &std::pair<Enumerator, Meaning>::first);
  return found == std::end(known) ? std::nullopt : std::optional<Meaning>(found->second);
}

// The first enumerator with this meaning.
template <typename Enumerator, typename Meaning, size_t kCount>
Enumerator EnumeratorOf(Meaning meaning, const std::pair<Enumerator, Meaning> (&known)[kCount]) {
  const auto* const found =
      std::ranges::find(known, meaning, &std::pair<Enumerator, Meaning>::second);
  return found == std::end(known) ? Enumerator() : found->first;
}

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_ENUMERATORS_H_
