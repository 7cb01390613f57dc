#ifndef BCCSKEL_SERVER_DURABLE_UPLOAD_SESSION_H_
#define BCCSKEL_SERVER_DURABLE_UPLOAD_SESSION_H_

#include <cstdint>
#include <memory>
#include <mutex>
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
  uint64_t committed() const;
  Time used() const;

  // Give the right to write until EndWriting().
  // Errors: ABORTED while somebody has it; OUT_OF_RANGE for a wrong offset, and for more or fewer
  //         bytes than declared; INVALID_ARGUMENT for another size than declared.
  absl::Status BeginAppend(uint64_t offset, uint64_t size);
  absl::Status BeginFinish(uint64_t size);
  void EndWriting(Time now);
  // Needs: the right to write.
  UploadFile& file() { return *file_; }

  void set_along(std::shared_ptr<Run> run);
  std::shared_ptr<Run> along() const;
  // It decodes no longer.
  std::shared_ptr<Run> TakeAlong();

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

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_UPLOAD_SESSION_H_
