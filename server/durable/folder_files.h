#ifndef BCCSKEL_SERVER_DURABLE_FOLDER_FILES_H_
#define BCCSKEL_SERVER_DURABLE_FOLDER_FILES_H_

#include <set>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/durable/durable_options.h"
#include "server/store/blob_store.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"
#include "server/store/upload_file.h"

namespace bccskel::server {

// Compares the files of the data folder with the tables. Files that no table names stay for a day;
// if a named file is missing, they stay for good.
// Threads: one at a time, the store's, except for OldFiles().
class FolderFiles {
 public:
  FolderFiles(const DurableOptions& options, FolderLock lock)
      : options_(options), blobs_(options.data_directory), lock_(std::move(lock)) {}

  // Called before opening a job store in the folder, which would create missing files.
  // Errors: FAILED_PRECONDITION if the tables or their log are missing.
  static absl::Status CheckTables(const std::string& tables, const DurableOptions& options);

  // For the sole owner of the folder: takes over and sweeps the files that an earlier process left.
  // Errors: FAILED_PRECONDITION for files of another job store.
  absl::Status TakeOver(JobStore& store);
  // For servers that share the folder: unnamed files may be new ones of others. Errors: as
  // TakeOver().
  absl::Status Join(JobStore& store);
  // Files last written more than `keep_unknown` ago. Reads the folder.
  std::set<std::string> OldFiles() const;
  // Removes the files in `old` that no table names.
  absl::Status Sweep(JobStore& store, const std::set<std::string>& old);
  // Removes deleted files that a crash or the file system has left.
  absl::Status RemoveDeleted(JobStore& store);
  // Records for the next process that this one was alive.
  void Touch(Time now) { lock_.Touch(now); }

 private:
  // The paths of all files that the tables name, including unconfirmed results.
  absl::StatusOr<std::set<std::string>> Known(JobStore& store) const;
  void SweepAtStart(JobStore& store, const std::set<std::string>& files,
                    const std::set<std::string>& known) const;
  absl::Status Remove(JobStore& store, const RemovalRow& row) const;

  const DurableOptions& options_;
  const BlobStore blobs_;
  FolderLock lock_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FOLDER_FILES_H_
