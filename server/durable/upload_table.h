#ifndef BCCSKEL_SERVER_DURABLE_UPLOAD_TABLE_H_
#define BCCSKEL_SERVER_DURABLE_UPLOAD_TABLE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "server/durable/run.h"
#include "server/store/rows.h"
#include "server/store/upload_file.h"

namespace bccskel::server {

// An unfinished upload: who may write it now, and what decodes it along.
// Threads: safe, but for file().
class UploadSession {
 public:
  UploadSession(UploadRow row, std::unique_ptr<UploadFile> file, Time used)
      : row_(std::move(row)), committed_(file->size()), used_(used), file_(std::move(file)) {}

  const UploadRow& row() const { return row_; }
  uint64_t committed() const {
    std::lock_guard lock(mutex_);
    return committed_;
  }
  Time used() const {
    std::lock_guard lock(mutex_);
    return used_;
  }

  // Give the right to write until EndWriting().
  // Errors: ABORTED while somebody has it; OUT_OF_RANGE for a wrong offset, and for more or fewer
  //         bytes than declared; INVALID_ARGUMENT for another size than declared.
  absl::Status BeginAppend(uint64_t offset, uint64_t size);
  absl::Status BeginFinish(uint64_t size);
  void EndWriting(Time now) {
    std::lock_guard lock(mutex_);
    writing_ = false;
    committed_ = file_->size();
    used_ = now;
  }
  // Needs: the right to write.
  UploadFile& file() { return *file_; }

  void set_along(std::shared_ptr<Run> run) {
    std::lock_guard lock(mutex_);
    along_ = std::move(run);
  }
  std::shared_ptr<Run> along() const {
    std::lock_guard lock(mutex_);
    return along_;
  }
  // It decodes no longer.
  std::shared_ptr<Run> TakeAlong() {
    std::lock_guard lock(mutex_);
    return std::exchange(along_, nullptr);
  }

 private:
  absl::Status Begin();  // Needs: mutex_ held.

  const UploadRow row_;
  mutable std::mutex mutex_;
  bool writing_ = false;        // guarded by mutex_
  uint64_t committed_;          // guarded by mutex_
  Time used_;                   // guarded by mutex_
  std::shared_ptr<Run> along_;  // guarded by mutex_
  std::unique_ptr<UploadFile> file_;
};

// Unfinished uploads that go on here, or soon will.
// Threads: safe.
class UploadTable {
 public:
  using Session = std::shared_ptr<UploadSession>;

  // Null: none, or it is being opened.
  Session Find(const std::string& tenant, const std::string& upload) const {
    std::lock_guard lock(mutex_);
    const auto found = sessions_.find({tenant, upload});
    return found == sessions_.end() ? nullptr : found->second;
  }
  size_t size() const {
    std::lock_guard lock(mutex_);
    return sessions_.size();
  }
  // Until it is added or removed nobody else opens it. False where it is there, or being opened.
  bool BeginOpening(const UploadRow& row) {
    std::lock_guard lock(mutex_);
    return sessions_.try_emplace(KeyOf(row)).second;
  }
  // It could not be opened.
  void EndOpening(const UploadRow& row) {
    std::lock_guard lock(mutex_);
    const auto found = sessions_.find(KeyOf(row));
    if (found != sessions_.end() && found->second == nullptr) sessions_.erase(found);
  }
  void Add(const Session& session) {
    std::lock_guard lock(mutex_);
    sessions_[KeyOf(session->row())] = session;
  }
  void Remove(const UploadRow& row) {
    std::lock_guard lock(mutex_);
    sessions_.erase(KeyOf(row));
  }
  // Another server goes on with it in another file.
  void Remove(const Session& session) {
    std::lock_guard lock(mutex_);
    const auto found = sessions_.find(KeyOf(session->row()));
    if (found != sessions_.end() && found->second == session) sessions_.erase(found);
  }
  // None is decoded along any more.
  void TakeAllAlong() {
    std::lock_guard lock(mutex_);
    for (const auto& [key, session] : sessions_) {
      if (session != nullptr) session->TakeAlong();
    }
  }

 private:
  using Key = std::pair<std::string, std::string>;  // tenant, name
  static Key KeyOf(const UploadRow& row) { return {row.tenant, row.name}; }

  mutable std::mutex mutex_;
  std::map<Key, Session> sessions_;  // guarded by mutex_; null while it is opened
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_UPLOAD_TABLE_H_
