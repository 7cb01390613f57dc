#ifndef BCCSKEL_SERVER_CALLS_UPLOAD_WRITERS_H_
#define BCCSKEL_SERVER_CALLS_UPLOAD_WRITERS_H_

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace bccskel::server {

// Sees that at most one stream writes an upload. A newer stream takes it over from an older one: a
// caller who comes again after a break must not wait until the server has noticed the break.
// Needs: outlives its turns.
// Threads: safe.
class UploadWriters {
 public:
  using Key = std::pair<std::string, std::string>;  // tenant, upload
  using Turn = std::shared_ptr<void>;               // the right to write, until it is let go of

  // Both are called at most once, from any thread, and must not block.
  class Writer {
   public:
    virtual ~Writer() = default;
    virtual void OnTurn(Turn turn) = 0;
    // Another writer waits: the turn is to be given back as soon as nothing is under way.
    virtual void OnTakenOver() = 0;
  };

  // OnTurn() comes now, or when the writer before has given its turn back.
  void Claim(const Key& key, const std::shared_ptr<Writer>& writer);

 private:
  struct Place {
    std::weak_ptr<Writer> holder;
    std::shared_ptr<Writer> next;
  };
  Turn TurnAt(const Key& key) {
    return {this, [key](UploadWriters* writers) { writers->GiveBack(key); }};
  }
  void GiveBack(const Key& key);

  std::mutex mutex_;
  std::map<Key, Place> places_;  // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_UPLOAD_WRITERS_H_
