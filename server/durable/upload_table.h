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

// An unfinished upload: the right to write it, and the run that decodes it as it arrives.
// Threads: safe, except for file().
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

  // Acquire the right to write until EndWriting().
  // Errors: ABORTED while another call has it; OUT_OF_RANGE for a wrong offset, and for more or
  //         fewer bytes than declared; INVALID_ARGUMENT for a size other than declared.
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

  void set_decoder(std::shared_ptr<Run> run) {
    std::lock_guard lock(mutex_);
    decoder_ = std::move(run);
  }
  std::shared_ptr<Run> decoder() const {
    std::lock_guard lock(mutex_);
    return decoder_;
  }
  // Detaches the run that decodes the upload.
  std::shared_ptr<Run> DetachDecoder() {
    std::lock_guard lock(mutex_);
    return std::exchange(decoder_, nullptr);
  }

 private:
  absl::Status Begin();  // Needs: mutex_ held.

  const UploadRow row_;
  mutable std::mutex mutex_;
  bool writing_ = false;          // guarded by mutex_
  uint64_t committed_;            // guarded by mutex_
  Time used_;                     // guarded by mutex_
  std::shared_ptr<Run> decoder_;  // guarded by mutex_
  std::unique_ptr<UploadFile> file_;
};

// The unfinished uploads that this server continues or is about to.
// Threads: safe.
class UploadTable {
 public:
  using Session = std::shared_ptr<UploadSession>;

  // Null if there is none or it is being opened.
  Session Find(const std::string& tenant, const std::string& upload) const {
    std::lock_guard lock(mutex_);
    const auto found = sessions_.find({tenant, upload});
    return found == sessions_.end() ? nullptr : found->second;
  }
  size_t size() const {
    std::lock_guard lock(mutex_);
    return sessions_.size();
  }
  // Reserves the opening until Add() or EndOpening(). False if the upload is open or being opened.
  bool BeginOpening(const UploadRow& row) {
    std::lock_guard lock(mutex_);
    return sessions_.try_emplace(KeyOf(row)).second;
  }
  // Cancels the reservation after a failure to open.
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
  // Removes exactly this session: another server continues the upload in another file.
  void Remove(const Session& session) {
    std::lock_guard lock(mutex_);
    const auto found = sessions_.find(KeyOf(session->row()));
    if (found != sessions_.end() && found->second == session) sessions_.erase(found);
  }
  // Detaches the runs of all uploads.
  void DetachAllDecoders() {
    std::lock_guard lock(mutex_);
    for (const auto& [key, session] : sessions_) {
      if (session != nullptr) session->DetachDecoder();
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
