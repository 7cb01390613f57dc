#ifndef BCCSKEL_SERVER_CALLS_CHOOSING_STREAM_H_
#define BCCSKEL_SERVER_CALLS_CHOOSING_STREAM_H_

#include <memory>
#include <mutex>
#include <utility>

#include "server/calls/durable_skeletonize.h"
#include "server/calls/skeletonize_stream.h"

namespace bccskel::server {

// A Skeletonize call on a server with a ledger: its config decides whether the job is durable or
// lives in memory.
class ChoosingStream final : public SkeletonizeStream {
 public:
  // Needs: everything outlives the call.
  ChoosingStream(CallFacts facts, JobRunner& runner, const VolumeLimits& limits, Ledger& ledger,
                 UploadWriters& writers)
      : SkeletonizeStream(std::move(facts), runner, limits), ledger_(ledger), writers_(writers) {}

  void OnReadDone(bool ok) override {
    if (durable_ != nullptr) return durable_->OnReadDone(ok);
    const bool first = std::exchange(first_, false);
    if (first && ok && request().has_config() &&
        DurableSkeletonize::Suits(request().config(), limits())) {
      return GoDurable();
    }
    SkeletonizeStream::OnReadDone(ok);
  }

  void OnWriteDone(bool ok) override {
    if (durable_ != nullptr) return durable_->OnWriteDone(ok);
    SkeletonizeStream::OnWriteDone(ok);
  }

  void OnCancel() override {
    if (const auto durable = CloseChoice()) return durable->OnCancel();
    SkeletonizeStream::OnCancel();
  }

  void EndEarly(const absl::Status& why) override {
    if (const auto durable = CloseChoice()) return durable->EndEarly(why);
    SkeletonizeStream::EndEarly(why);
  }

  absl::Status CheckSender(TimePoint now, std::chrono::milliseconds limit) override {
    std::unique_lock lock(choice_);
    const std::shared_ptr<DurableSkeletonize> durable = durable_;
    lock.unlock();
    if (durable != nullptr) return durable->CheckSender(now, limit);
    return SkeletonizeStream::CheckSender(now, limit);
  }

  void OnDone() override {
    if (durable_ == nullptr) return SkeletonizeStream::OnDone();
    const auto self = LetGo();
    durable_->OnDone();
  }

 private:
  // What the choice was, if there was one; there is none later.
  std::shared_ptr<DurableSkeletonize> CloseChoice() {
    std::lock_guard lock(choice_);
    closed_ = true;
    return durable_;
  }

  void GoDurable() {
    std::unique_lock lock(choice_);
    if (closed_) return;  // and ended
    durable_ = std::make_shared<DurableSkeletonize>(DurableCall{facts(), ledger_}, writers_, *this);
    lock.unlock();
    durable_->Begin(request().config());
  }

  Ledger& ledger_;
  UploadWriters& writers_;
  bool first_ = true;  // read reactions only

  std::mutex choice_;
  bool closed_ = false;  // guarded by choice_: the call has ended
  // Set once, guarded by choice_; reads and writes come after that in any case.
  std::shared_ptr<DurableSkeletonize> durable_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_CHOOSING_STREAM_H_
