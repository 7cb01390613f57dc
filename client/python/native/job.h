#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_JOB_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_JOB_H_

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/status_macros.h"

namespace bccskel::python {

// The communication of a job's thread with the Python thread that waits for it.
class Job {
 public:
  struct Progress {
    uint64_t done = 0;
    uint64_t total = 0;
  };

  std::stop_token stop() const { return stop_.get_token(); }
  void RequestStop() { stop_.request_stop(); }

  // Called on the job's thread. A new report replaces an undelivered one.
  void Report(const Progress& progress);
  void Finish();

  // News so far; empty if there is none after `patience`.
  struct News {
    std::optional<Progress> progress;
    bool finished = false;
  };
  News Wait(std::chrono::milliseconds patience);

 private:
  std::stop_source stop_;
  std::mutex mutex_;
  std::condition_variable changed_;
  News news_;
};

// Runs `work` on a separate thread without the interpreter's lock, while this thread calls
// `progress(done, total)`, unless it is None, and handles signals. If either raises, the job is
// stopped and the exception propagates. Needs: the interpreter's lock.
// Throws: the error of the work as ThrowIfError() does.
void RunJob(const pybind11::object& progress, const std::function<absl::Status(Job&)>& work);

// The same for work that returns an absl::StatusOr; returns its value.
template <typename Work>
auto RunFor(const pybind11::object& progress, const Work& work) {
  typename decltype(work(std::declval<Job&>()))::value_type value;
  RunJob(progress, [&](Job& job) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(value, work(job));
    return absl::OkStatus();
  });
  return value;
}

// Throws the Python exception for an error: ValueError for INVALID_ARGUMENT, and so on.
void ThrowIfError(const absl::Status& status);
template <typename T>
T Value(absl::StatusOr<T> value) {
  ThrowIfError(value.status());
  return *std::move(value);
}

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_JOB_H_
