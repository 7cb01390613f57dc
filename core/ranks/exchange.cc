#include "core/ranks/exchange.h"

#include <utility>

namespace bccskel::ranks {

std::vector<Bytes> TradeWithAll(Exchange& exchange, std::vector<Bytes> out) {
  const int own = exchange.rank();
  std::vector<int> peers;
  for (int rank = 0; rank < exchange.size(); ++rank) {
    if (rank != own) peers.push_back(rank);
  }
  Bytes kept = std::move(out[static_cast<size_t>(own)]);
  out.erase(out.begin() + own);
  std::vector<Bytes> in(peers.size());
  exchange.Trade(peers, out, in);
  in.insert(in.begin() + own, std::move(kept));
  return in;
}

std::vector<uint64_t> ShareNumber(Exchange& exchange, uint64_t number) {
  std::vector<uint64_t> numbers(static_cast<size_t>(exchange.size()));
  numbers[static_cast<size_t>(exchange.rank())] = number;
  exchange.Sum(numbers);
  return numbers;
}

std::vector<Bytes> Gather(Exchange& exchange, Bytes out) {
  const auto size = static_cast<size_t>(exchange.size());
  if (exchange.rank() != 0) {
    const int root = 0;
    Bytes in;
    exchange.Trade({&root, 1}, {&out, 1}, {&in, 1});
    return {};
  }
  std::vector<int> peers;
  for (int rank = 1; rank < exchange.size(); ++rank) peers.push_back(rank);
  std::vector<Bytes> in(size);
  in[0] = std::move(out);
  const std::vector<Bytes> nothing(size - 1);
  exchange.Trade(peers, nothing, std::span(in).subspan(1));
  return in;
}

}  // namespace bccskel::ranks
