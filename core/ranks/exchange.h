#ifndef BCCSKEL_CORE_RANKS_EXCHANGE_H_
#define BCCSKEL_CORE_RANKS_EXCHANGE_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/uninitialized.h"

namespace bccskel::ranks {

// Messages of some MiB are exchanged in rounds; large ones reuse their memory.
using Bytes = exec::UninitializedVector<std::byte>;

// The stages of a job, for communication counts.
enum class Stage : uint8_t { kSharing, kDistances, kThinning, kTopology, kGathering };
inline constexpr size_t kStageCount = 5;

// Communication between the ranks of a job. All ranks make the same calls in the same order.
// If a rank is lost, calls may not return: the launcher of the ranks ends the others.
// Threads: one thread of each rank.
class Exchange {
 public:
  virtual ~Exchange() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  // Sends `out[n]` to rank peers[n] and receives its message in `in[n]`.
  // Needs: peers name each other; no rank is its own peer; peers increase.
  virtual void Trade(std::span<const int> peers, std::span<const Bytes> out,
                     std::span<Bytes> in) = 0;

  // Counts the following calls for another stage.
  virtual void Enter(Stage) {}

  // Replaces each number by its sum over all ranks, modulo 2^64.
  virtual void Sum(std::span<uint64_t> numbers) = 0;
  // Replaces each number by its maximum over all ranks.
  virtual void Max(std::span<uint64_t> numbers) = 0;
};

// Sends `out[r]` to each rank r, itself included. Returns the messages received, by rank.
std::vector<Bytes> TradeWithAll(Exchange& exchange, std::vector<Bytes> out);

// Returns the number of each rank, by rank.
std::vector<uint64_t> ShareNumber(Exchange& exchange, uint64_t number);

// Returns the messages of all ranks on rank 0, by rank; nothing elsewhere.
std::vector<Bytes> Gather(Exchange& exchange, Bytes out);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_EXCHANGE_H_
