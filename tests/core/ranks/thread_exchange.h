#ifndef BCCSKEL_TESTS_CORE_RANKS_THREAD_EXCHANGE_H_
#define BCCSKEL_TESTS_CORE_RANKS_THREAD_EXCHANGE_H_

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "core/ranks/exchange.h"

namespace bccskel::ranks {

// Messages between all pairs of ranks, in the order in which they were sent. Threads: safe.
class MailRoom {
 public:
  void Send(int from, int to, const Bytes& letter) {
    const std::lock_guard lock(mutex_);
    boxes_[{from, to}].push_back(letter);
    sent_.notify_all();
  }
  Bytes Receive(int from, int to) {
    std::unique_lock lock(mutex_);
    std::deque<Bytes>& box = boxes_[{from, to}];
    sent_.wait(lock, [&] { return !box.empty(); });
    Bytes letter = std::move(box.front());
    box.pop_front();
    return letter;
  }

 private:
  std::mutex mutex_;
  std::condition_variable sent_;
  std::map<std::pair<int, int>, std::deque<Bytes>> boxes_;
};

class ThreadExchange : public Exchange {
 public:
  ThreadExchange(int rank, int size, MailRoom& mail) : rank_(rank), size_(size), mail_(mail) {}

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void Trade(std::span<const int> peers, std::span<const Bytes> out, std::span<Bytes> in) override {
    for (size_t n = 0; n < peers.size(); ++n) mail_.Send(rank_, peers[n], out[n]);
    for (size_t n = 0; n < peers.size(); ++n) in[n] = mail_.Receive(peers[n], rank_);
  }
  void Sum(std::span<uint64_t> numbers) override { Reduce(numbers, std::plus<uint64_t>()); }
  void Max(std::span<uint64_t> numbers) override {
    Reduce(numbers, [](uint64_t a, uint64_t b) { return std::max(a, b); });
  }

 private:
  template <typename Join>
  void Reduce(std::span<uint64_t> numbers, Join join) {
    const std::span<const std::byte> own = std::as_bytes(numbers);
    const std::vector<Bytes> out(static_cast<size_t>(size_), Bytes(own.begin(), own.end()));
    std::ranges::fill(numbers, 0);
    std::vector<uint64_t> theirs(numbers.size());
    for (const Bytes& letter : TradeWithAll(*this, out)) {
      std::ranges::copy(letter, std::as_writable_bytes(std::span(theirs)).begin());
      std::ranges::transform(numbers, theirs, numbers.begin(), join);
    }
  }

  const int rank_, size_;
  MailRoom& mail_;
};

// Runs `work` as each of `size` ranks, threads of this process, and returns when all are done.
// Needs: size >= 1; `work` throws nothing.
inline void RunAsThreads(int size, const std::function<void(Exchange&)>& work) {
  MailRoom mail;
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < size; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadExchange exchange(rank, size, mail);
      work(exchange);
    });
  }
}

}  // namespace bccskel::ranks

#endif  // BCCSKEL_TESTS_CORE_RANKS_THREAD_EXCHANGE_H_
