#ifndef BCCSKEL_CLIENT_CLI_FILE_WRITERS_H_
#define BCCSKEL_CLIENT_CLI_FILE_WRITERS_H_

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/status/status.h"

namespace bccskel::cli {

// Writes many small files concurrently: each file is synced before it gets its name, and the disk
// syncs 16 files in about the time of one. Starts threads with the first task.
// Threads: Add() and Finish() from one thread; tasks run on others.
class FileWriters {
 public:
  using Task = std::function<absl::Status()>;

  static constexpr size_t kMostWriters = 16;

  // Fewer threads for files that take longer to compose than to write.
  explicit FileWriters(size_t most_writers = kMostWriters) : most_writers_(most_writers) {}
  ~FileWriters();  // as Finish()
  FileWriters(const FileWriters&) = delete;
  FileWriters& operator=(const FileWriters&) = delete;

  // Blocks while many tasks wait. Errors: the first of all tasks so far; later tasks are dropped.
  absl::Status Add(Task task);

  // Waits for all tasks; none may be added afterwards. Errors: as above.
  absl::Status Finish();

 private:
  void Write();

  const size_t most_writers_;
  std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable work_;
  std::deque<Task> tasks_;
  absl::Status status_;
  bool ended_ = false;
  std::vector<std::jthread> writers_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_FILE_WRITERS_H_
