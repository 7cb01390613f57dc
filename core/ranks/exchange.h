#ifndef BCCSKEL_CORE_RANKS_EXCHANGE_H_
#define BCCSKEL_CORE_RANKS_EXCHANGE_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bccskel::ranks {

using Bytes = std::vector<std::byte>;

// What ranks are at, for those who count what they say to each other.
enum class Stage : uint8_t { kSharing, kDistances, kThinning, kTopology, kGathering };
inline constexpr size_t kStageCount = 5;

// What the ranks of a job say to each other. All ranks make the same calls in the same order.
// Where a rank is lost, calls need not come back: whoever started the ranks ends the others.
// Threads: one thread of each rank.
class Exchange {
 public:
  virtual ~Exchange() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  // Sends `out[n]` to rank peers[n] and takes what that one sends here to `in[n]`.
  // Needs: peers of each other name each other; no rank is its own peer; peers increase.
  virtual void Trade(std::span<const int> peers, std::span<const Bytes> out,
                     std::span<Bytes> in) = 0;

  // What follows belongs to another stage.
  virtual void Enter(Stage) {}

  // Puts the sum over all ranks, modulo 2^64, in the place of each number.
  virtual void Sum(std::span<uint64_t> numbers) = 0;
  // Puts the largest of all ranks in the place of each number.
  virtual void Max(std::span<uint64_t> numbers) = 0;
};

// Sends `out[r]` to each rank r, also to itself. Returns what each sends here, by rank.
std::vector<Bytes> TradeWithAll(Exchange& exchange, std::vector<Bytes> out);

// Each rank's number, by rank.
std::vector<uint64_t> ShareNumber(Exchange& exchange, uint64_t number);

// Returns what each sends to rank 0 there, by rank; nothing elsewhere.
std::vector<Bytes> Gather(Exchange& exchange, Bytes out);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_EXCHANGE_H_
