#include "core/ranks/thread_exchange.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

namespace bccskel::ranks {
namespace {

// Messages between all pairs of ranks, in the order in which they were sent.
class MailRoom {
 public:
  explicit MailRoom(int size) : size_(size), boxes_(static_cast<size_t>(size * size)) {}

  int size() const { return size_; }

  void Send(int from, int to, Bytes letter) {
    {
      const std::lock_guard lock(mutex_);
      BoxOf(from, to).push_back(std::move(letter));
    }
    sent_.notify_all();
  }
  Bytes Receive(int from, int to) {
    std::unique_lock lock(mutex_);
    std::deque<Bytes>& box = BoxOf(from, to);
    sent_.wait(lock, [&] { return !box.empty(); });
    Bytes letter = std::move(box.front());
    box.pop_front();
    return letter;
  }

 private:
  std::deque<Bytes>& BoxOf(int from, int to) {
    return boxes_[static_cast<size_t>(from * size_ + to)];
  }

  const int size_;
  std::mutex mutex_;
  std::condition_variable sent_;
  std::vector<std::deque<Bytes>> boxes_;  // guarded by mutex_
};

class ThreadExchange : public Exchange {
 public:
  ThreadExchange(int rank, MailRoom& mail) : rank_(rank), mail_(mail) {}

  int rank() const override { return rank_; }
  int size() const override { return mail_.size(); }

  void Trade(std::span<const int> peers, std::span<const Bytes> out, std::span<Bytes> in) override {
    for (size_t n = 0; n < peers.size(); ++n) mail_.Send(rank_, peers[n], out[n]);
    for (size_t n = 0; n < peers.size(); ++n) in[n] = mail_.Receive(peers[n], rank_);
  }

  void Sum(std::span<uint64_t> numbers) override {
    Reduce(numbers, [](uint64_t a, uint64_t b) { return a + b; });
  }
  void Max(std::span<uint64_t> numbers) override {
    Reduce(numbers, [](uint64_t a, uint64_t b) { return std::max(a, b); });
  }

 private:
  template <typename Join>
  void Reduce(std::span<uint64_t> numbers, Join join) {
    const std::span<const std::byte> own = std::as_bytes(numbers);
    const Bytes letter(own.begin(), own.end());
    for (int rank = 0; rank < size(); ++rank) {
      if (rank != rank_) mail_.Send(rank_, rank, letter);
    }
    for (int rank = 0; rank < size(); ++rank) {
      if (rank == rank_) continue;
      const Bytes theirs = mail_.Receive(rank, rank_);
      const auto* values = reinterpret_cast<const uint64_t*>(theirs.data());
      for (size_t n = 0; n < numbers.size(); ++n) numbers[n] = join(numbers[n], values[n]);
    }
  }

  const int rank_;
  MailRoom& mail_;
};

}  // namespace

void RunAsThreads(int size, const std::function<void(Exchange&)>& work) {
  MailRoom mail(size);
  std::vector<std::jthread> threads;
  for (int rank = 1; rank < size; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadExchange exchange(rank, mail);
      work(exchange);
    });
  }
  ThreadExchange exchange(0, mail);
  work(exchange);
}

}  // namespace bccskel::ranks
