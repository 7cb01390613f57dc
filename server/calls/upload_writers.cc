#include "server/calls/upload_writers.h"

namespace bccskel::server {

void UploadWriters::Claim(const Key& key, const std::shared_ptr<Writer>& writer) {
  std::unique_lock lock(mutex_);
  const auto [place, free] = places_.try_emplace(key);
  if (free) {
    place->second.holder = writer;
    lock.unlock();
    return writer->OnTurn(TurnAt(key));
  }
  const std::shared_ptr<Writer> waited = std::exchange(place->second.next, writer);
  // A holder that has been told already, by the one that waited, is on its way out.
  const std::shared_ptr<Writer> holder = waited == nullptr ? place->second.holder.lock() : nullptr;
  lock.unlock();
  if (waited != nullptr) waited->OnTakenOver();
  if (holder != nullptr) holder->OnTakenOver();
}

void UploadWriters::GiveBack(const Key& key) {
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

}  // namespace bccskel::server
