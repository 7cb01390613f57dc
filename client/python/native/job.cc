#include "client/python/native/job.h"

#include <exception>
#include <string>
#include <thread>

#include "client/cli/option_values.h"

namespace bccskel::python {
namespace {

namespace py = pybind11;

// The longest delay of Ctrl-C.
constexpr std::chrono::milliseconds kPatience(50);

PyObject* ExceptionFor(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kOutOfRange:
    case absl::StatusCode::kFailedPrecondition:
      return PyExc_ValueError;
    case absl::StatusCode::kNotFound:
      return PyExc_FileNotFoundError;
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kUnauthenticated:
      return PyExc_PermissionError;
    case absl::StatusCode::kResourceExhausted:
      return PyExc_MemoryError;
    case absl::StatusCode::kUnavailable:
      return PyExc_ConnectionError;
    case absl::StatusCode::kDeadlineExceeded:
      return PyExc_TimeoutError;
    case absl::StatusCode::kUnimplemented:
      return PyExc_NotImplementedError;
    default:
      return PyExc_RuntimeError;
  }
}

// Passes on the job's progress until it is done. Throws py::error_already_set.
void Attend(Job& job, const py::object& progress) {
  Job::News news;
  while (!news.finished) {
    {
      const py::gil_scoped_release release;
      news = job.Wait(kPatience);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (news.progress.has_value() && !progress.is_none()) {
      progress(news.progress->done, news.progress->total);
    }
  }
}

}  // namespace

void Job::Report(const Progress& progress) {
  const std::lock_guard lock(mutex_);
  news_.progress = progress;
}

void Job::Finish() {
  const std::lock_guard lock(mutex_);
  news_.finished = true;
  changed_.notify_one();
}

Job::News Job::Wait(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [this] { return news_.finished; });
  const News news = news_;
  news_.progress.reset();
  return news;
}

void RunJob(const py::object& progress, const std::function<absl::Status(Job&)>& work) {
  Job job;
  absl::Status status;
  std::exception_ptr thrown;
  std::exception_ptr raised;  // by Python
  std::thread thread([&] {
    try {
      status = work(job);
    } catch (...) {
      thrown = std::current_exception();
    }
    job.Finish();
  });
  try {
    Attend(job, progress);
  } catch (...) {
    raised = std::current_exception();
    job.RequestStop();
  }
  {
    const py::gil_scoped_release release;
    thread.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (thrown) std::rethrow_exception(thrown);
  ThrowIfError(status);
}

void ThrowIfError(const absl::Status& status) {
  if (status.ok()) return;
  const std::string message = cli::WithOptionNames(std::string(status.message()));
  PyErr_SetString(ExceptionFor(status.code()), message.c_str());
  throw py::error_already_set();
}

}  // namespace bccskel::python
