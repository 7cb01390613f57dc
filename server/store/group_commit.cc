#include "server/store/group_commit.h"

#include <algorithm>
#include <utility>

#include "core/exec/status_macros.h"

namespace bccskel::server {

GroupCommit::GroupCommit(std::unique_ptr<JobStore> store)
    : store_(std::move(store)), thread_([this](std::stop_token stop) { Serve(stop); }) {}

GroupCommit::~GroupCommit() { thread_.request_stop(); }

void GroupCommit::Post(Change change, Done done) {
  {
    std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(change), std::move(done)});
  }
  wake_.notify_one();
}

void GroupCommit::Post(std::function<void()> task) {
  Post(nullptr, [task = std::move(task)](const absl::Status&) { task(); });
}

void GroupCommit::Serve(std::stop_token stop) {
  while (true) {
    std::vector<Entry> batch;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [this] { return !waiting_.empty(); });
      if (waiting_.empty()) return;
      batch.swap(waiting_);
    }
    Write(batch);
    for (Entry& entry : batch) {
      if (entry.done) entry.done(std::move(entry.status));
    }
  }
}

void GroupCommit::Write(std::vector<Entry>& batch) {
  if (std::ranges::none_of(batch, [](const Entry& entry) { return entry.change != nullptr; })) {
    return;
  }
  const absl::Status written = WriteAll(batch);
  ++commits_;
  if (written.ok()) return;
  store_->Rollback();
  for (Entry& entry : batch) {
    if (entry.change != nullptr && entry.status.ok()) entry.status = written;
  }
}

absl::Status GroupCommit::WriteAll(std::vector<Entry>& batch) {
  BCCSKEL_RETURN_IF_ERROR(store_->Begin());
  for (Entry& entry : batch) {
    if (entry.change != nullptr) BCCSKEL_RETURN_IF_ERROR(RunStep(entry));
  }
  return store_->Commit();
}

// Errors: of the store, not of the change.
absl::Status GroupCommit::RunStep(Entry& entry) {
  BCCSKEL_RETURN_IF_ERROR(store_->BeginStep());
  entry.status = entry.change(*store_);
  if (entry.status.ok()) return store_->KeepStep();
  // When the step's error has ended the whole transaction, there is nothing to undo: then this
  // fails, and so does all.
  return store_->UndoStep();
}

}  // namespace bccskel::server
