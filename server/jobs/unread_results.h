#ifndef BCCSKEL_SERVER_JOBS_UNREAD_RESULTS_H_
#define BCCSKEL_SERVER_JOBS_UNREAD_RESULTS_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace bccskel::server {

// Counts the memory of results that were handed out and are not let go of yet.
// Threads: safe.
class UnreadResults : public std::enable_shared_from_this<UnreadResults> {
 public:
  uint64_t bytes() const { return bytes_; }

  // Counts `bytes` until what it returns is let go of; then `wake` is called.
  std::shared_ptr<void> Hold(uint64_t bytes, std::function<void()> wake) {
    bytes_ += bytes;
    return std::make_shared<Share>(shared_from_this(), bytes, std::move(wake));
  }

 private:
  class Share {
   public:
    Share(std::shared_ptr<UnreadResults> all, uint64_t bytes, std::function<void()> wake)
        : all_(std::move(all)), bytes_(bytes), wake_(std::move(wake)) {}
    ~Share() {
      all_->bytes_ -= bytes_;
      wake_();
    }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

   private:
    const std::shared_ptr<UnreadResults> all_;
    const uint64_t bytes_;
    const std::function<void()> wake_;
  };

  std::atomic<uint64_t> bytes_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_UNREAD_RESULTS_H_
