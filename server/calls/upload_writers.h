#ifndef BCCSKEL_SERVER_CALLS_UPLOAD_WRITERS_H_
#define BCCSKEL_SERVER_CALLS_UPLOAD_WRITERS_H_

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace bccskel::server {

// Ensures that at most one stream writes an upload. A newer stream takes over from an older one: a
// caller who returns after a broken connection must not wait until the server has noticed the
// break.
// Needs: outlives its turns.
// Threads: safe.
class UploadWriters {
 public:
  using Key = std::pair<std::string, std::string>;  // tenant, upload
  using Turn = std::shared_ptr<void>;  // the right to write, until the last copy is gone

  // Each member is called at most once, from any thread, and must not block.
  class Writer {
   public:
    virtual ~Writer() = default;
    virtual void OnTurn(Turn turn) = 0;
    // Another writer waits: release the turn as soon as no operation is in progress.
    virtual void OnTakenOver() = 0;
  };

  // Calls OnTurn() now, or when the writer before has released its turn.
  void Claim(const Key& key, const std::shared_ptr<Writer>& writer) {
    std::unique_lock lock(mutex_);
    const auto [place, free] = places_.try_emplace(key);
    if (free) {
      place->second.holder = writer;
      lock.unlock();
      return writer->OnTurn(TurnAt(key));
    }
    const std::shared_ptr<Writer> waited = std::exchange(place->second.next, writer);
    // If a writer waited already, the holder knows that it must release its turn.
    const std::shared_ptr<Writer> holder =
        waited == nullptr ? place->second.holder.lock() : nullptr;
    lock.unlock();
    if (waited != nullptr) waited->OnTakenOver();
    if (holder != nullptr) holder->OnTakenOver();
  }

 private:
  struct Place {
    std::weak_ptr<Writer> holder;
    std::shared_ptr<Writer> next;
  };
  Turn TurnAt(const Key& key) {
    return {this, [key](UploadWriters* writers) { writers->GiveBack(key); }};
  }
  void GiveBack(const Key& key) {
    std::unique_lock lock(mutex_);
    const auto place = places_.find(key);
    const std::shared_ptr<Writer> next = std::exchange(place->second.next, nullptr);
    if (next == nullptr) {
      places_.erase(place);
      return;
    }
    place->second.holder = next;
    lock.unlock();
    next->OnTurn(TurnAt(key));
  }

  std::mutex mutex_;
  std::map<Key, Place> places_;  // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_UPLOAD_WRITERS_H_
