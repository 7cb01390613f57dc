#include "client/cli/file_writers.h"

#include <cstddef>
#include <new>
#include <utility>

namespace bccskel::cli {
namespace {

constexpr size_t kMostWaiting = 64;

absl::Status StatusOf(const FileWriters::Task& task) {
  try {
    return task();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("not enough memory to write a file");
  }
}

}  // namespace

FileWriters::~FileWriters() { Finish().IgnoreError(); }

absl::Status FileWriters::Add(Task task) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return tasks_.size() < kMostWaiting; });
  tasks_.push_back(std::move(task));
  if (writers_.size() < most_writers_) writers_.emplace_back([this] { Write(); });
  work_.notify_one();
  return status_;
}

absl::Status FileWriters::Finish() {
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  work_.notify_all();
  writers_.clear();  // joins them
  return status_;
}

void FileWriters::Write() {
  std::unique_lock lock(mutex_);
  for (;;) {
    work_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    room_.notify_one();
    if (!status_.ok()) continue;
    lock.unlock();
    const absl::Status done = StatusOf(task);
    task = nullptr;  // frees what it holds
    lock.lock();
    status_.Update(done);
  }
}

}  // namespace bccskel::cli
