#include "server/store/group_commit.h"

#include <algorithm>
#include <utility>

#include "core/exec/status_macros.h"

namespace bccskel::server {

GroupCommit::GroupCommit(std::unique_ptr<JobStore> store, std::unique_ptr<DiskReserve> reserve)
    : store_(std::move(store)),
      reserve_(std::move(reserve)),
      thread_([this](std::stop_token stop) { Serve(stop); }) {}

GroupCommit::~GroupCommit() { thread_.request_stop(); }

void GroupCommit::Post(Change change, Done done, Room room) {
  {
    std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(change), std::move(done), room});
  }
  wake_.notify_one();
}

void GroupCommit::Post(std::function<void()> task) {
  Post(nullptr, [task = std::move(task)](const absl::Status&) { task(); });
}

void GroupCommit::Serve(std::stop_token stop) {
  while (true) {
    if (reserve_ != nullptr) reserve_->Hold();
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

// One change may make a transaction fail, for example for lack of space; bisection finds it and
// writes the others.
void GroupCommit::Write(std::span<Entry> batch) {
  if (std::ranges::none_of(batch, &Entry::IsToWrite)) return;
  absl::Status written = WriteAll(batch);
  // Forget() also empties the log, which frees space that a deletion needs.
  if (absl::IsResourceExhausted(written) && store_->Forget().ok()) written = WriteAll(batch);
  if (written.ok()) return;
  if (!absl::IsUnavailable(written) && batch.size() > 1) {
    Write(batch.first(batch.size() / 2));
    return Write(batch.subspan(batch.size() / 2));
  }
  if (absl::IsResourceExhausted(written)) written = WriteWithReserve(batch);
  for (Entry& entry : batch) {
    if (entry.IsToWrite()) entry.status = written;
  }
}

absl::Status GroupCommit::WriteWithReserve(std::span<Entry> batch) {
  const bool may = std::ranges::all_of(
      batch, [](const Entry& entry) { return !entry.IsToWrite() || entry.room == Room::kReserve; });
  if (!may || reserve_ == nullptr || !reserve_->held()) {
    return absl::ResourceExhaustedError("the disk is full");
  }
  reserve_->Release();
  store_->Forget().IgnoreError();
  absl::Status written = WriteAll(batch);
  store_->Forget().IgnoreError();
  reserve_->Hold();
  return written;
}

// Steps cost two statements per change, so they are used only after a change has failed halfway.
// Errors: the store's; nothing has happened then.
absl::Status GroupCommit::WriteAll(std::span<Entry> batch) {
  absl::Status written = WriteOnce(batch, Steps::kNone);
  if (absl::IsAborted(written)) written = WriteOnce(batch, Steps::kEach);
  NoteHealth(written);
  return written;
}

// Runs one transaction. Errors: ABORTED when steps are needed; else as WriteAll().
absl::Status GroupCommit::WriteOnce(std::span<Entry> batch, Steps steps) {
  absl::Status written = [&]() -> absl::Status {
    BCCSKEL_RETURN_IF_ERROR(store_->Begin());
    if (on_begin_) on_begin_();
    for (Entry& entry : batch) {
      if (!entry.IsToWrite()) continue;
      BCCSKEL_RETURN_IF_ERROR(steps == Steps::kEach ? RunStep(entry) : RunWithoutStep(entry));
    }
    return store_->Commit();
  }();
  if (!written.ok()) store_->Rollback();
  return written;
}

void GroupCommit::NoteHealth(const absl::Status& written) {
  std::lock_guard lock(mutex_);
  failure_ = absl::IsResourceExhausted(written) ? absl::OkStatus() : written;
}

absl::Status GroupCommit::Health() const {
  {
    std::lock_guard lock(mutex_);
    if (!failure_.ok()) return failure_;
  }
  return store_->Health();
}

absl::Status GroupCommit::RunWithoutStep(Entry& entry) {
  const uint64_t traces = store_->traces();
  entry.status = entry.change(*store_);
  if (entry.status.ok() || store_->traces() == traces) return absl::OkStatus();
  entry.status = absl::OkStatus();  // set by an earlier run
  return absl::AbortedError("a change has failed half done");
}

// Errors: the store's, not the change's.
absl::Status GroupCommit::RunStep(Entry& entry) {
  BCCSKEL_RETURN_IF_ERROR(store_->BeginStep());
  entry.status = entry.change(*store_);
  if (entry.status.ok()) return store_->KeepStep();
  // If the step's error has ended the whole transaction, there is nothing to undo: this call fails,
  // and with it the batch.
  return store_->UndoStep();
}

}  // namespace bccskel::server
