#include "tests/server/durable/fake_runner.h"

#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/volume/volume.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr int kShells = 3;
constexpr int kChunks = 3;

// Another text is another volume.
Volume VolumeOf(const std::string& text) {
  std::vector<LatticePoint> points;
  for (size_t n = 0; n < text.size(); ++n) {
    points.push_back({static_cast<int32_t>(2 * n), 2 * (text[n] & 0x7F), 0});
  }
  return VolumeOfPoints(points);
}

}  // namespace

absl::StatusOr<JobRequest> FakeCodec::RequestOf(const std::string& declaration,
                                                const std::string& options) const {
  JobRequest request;
  const size_t digits = declaration.find(' ');
  if (!absl::SimpleAtoi(declaration.substr(0, digits), &request.size_bytes)) {
    return absl::InvalidArgumentError(absl::StrCat("declaration: ", declaration));
  }
  if (options == "large") request.header.max_bricks = uint64_t{1} << 20;
  if (options == "bad") return absl::InvalidArgumentError("options: bad");
  return request;
}

absl::Status FakeCodec::WriteResult(const JobResult& result, const RecordSink& sink) const {
  using Kind = ResultRecord::Kind;
  const std::string& text = result.skeleton.method;
  for (int n = 0; n < kChunks; ++n) {
    BCCSKEL_RETURN_IF_ERROR(sink({Kind::kSkeletonChunk, absl::StrCat(text, " ", n)}));
  }
  return sink({Kind::kSummary, absl::StrCat("summary of ", text)});
}

class FakeJob final : public Job, public std::enable_shared_from_this<FakeJob> {
 public:
  FakeJob(FakeRunner& runner, std::shared_ptr<JobListener> listener)
      : runner_(runner), listener_(std::move(listener)) {}

  const std::string& name() const override { return name_; }
  void Append(std::string bytes) override {
    Post([this, bytes = std::move(bytes)] { Decode(bytes); });
  }
  void FinishVolume(std::optional<Sha256Digest>) override {
    Post([this] { Compute(); });
  }
  void EndWith(absl::Status why) override {
    Post([this, why = std::move(why)]() mutable { End(std::move(why)); });
  }

 private:
  void Post(std::function<void()> task) {
    std::lock_guard lock(runner_.mutex_);
    runner_.tasks_.push_back([self = shared_from_this(), task = std::move(task)] { task(); });
    runner_.changed_.notify_all();
  }

  void Decode(const std::string& bytes) {
    if (ended_) return;
    bytes_ += bytes;
    if (bytes_.find('!') != std::string::npos) {
      return End(absl::InvalidArgumentError("the volume is malformed"));
    }
    {
      std::lock_guard lock(runner_.mutex_);
      if (runner_.decoding_held_) return;
    }
    listener_->OnBytesConsumed();
  }

  void Compute() {
    if (ended_) return;
    listener_->OnVolume(VolumeOf(Text()));
    for (int shell = 1; shell <= kShells; ++shell) {
      listener_->OnShell({.shell = shell, .last_shell = kShells}, std::chrono::milliseconds(shell));
    }
    std::unique_lock lock(runner_.mutex_);
    if (const uint64_t needed = runner_.needed_bytes_; needed > 0) {
      lock.unlock();
      return End(MemoryBusy("too little is free", needed));
    }
    ++runner_.computing_;
    runner_.changed_.notify_all();
    const auto end = [self = shared_from_this()] { self->Succeed(); };
    if (runner_.held_) return runner_.waiting_.push_back(end);
    lock.unlock();
    Succeed();
  }

  void Succeed() {
    if (ended_) return;
    {
      std::lock_guard lock(runner_.mutex_);
      ++runner_.computed_;
    }
    JobResult result;
    result.skeleton.method = Text();
    End(std::move(result));
  }

  void End(absl::StatusOr<JobResult> result) {
    if (std::exchange(ended_, true)) return;
    const auto listener = std::exchange(listener_, nullptr);
    listener->OnEnd(std::move(result));
  }

  std::string Text() const { return bytes_.substr(0, bytes_.find('|')); }

  FakeRunner& runner_;
  std::shared_ptr<JobListener> listener_;
  const std::string name_ = "fake";
  // Touched by the runner's thread only.
  std::string bytes_;
  bool ended_ = false;
};

FakeRunner::FakeRunner() : thread_([this](std::stop_token stop) { Serve(stop); }) {}
FakeRunner::~FakeRunner() { thread_.request_stop(); }

void FakeRunner::Serve(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !tasks_.empty(); })) {
    const auto tasks = std::exchange(tasks_, {});
    lock.unlock();
    for (const auto& task : tasks) task();
    lock.lock();
  }
}

absl::StatusOr<std::shared_ptr<Job>> FakeRunner::Start(JobRequest request,
                                                       std::shared_ptr<JobListener> listener) {
  std::lock_guard lock(mutex_);
  BCCSKEL_RETURN_IF_ERROR(refusal_);
  if (needed_bytes_ > 0 && request.min_bytes >= needed_bytes_) {
    return MemoryBusy("too little is free", request.min_bytes);
  }
  min_bytes_ = request.min_bytes;
  ++started_;
  return std::make_shared<FakeJob>(*this, std::move(listener));
}

absl::StatusOr<std::shared_ptr<Job>> FakeRunner::Start(LabelsRequest,
                                                       std::shared_ptr<LabelsListener>) {
  return absl::UnimplementedError("no labels here");
}

void FakeRunner::Hold() {
  std::lock_guard lock(mutex_);
  held_ = true;
}

void FakeRunner::Release() {
  std::lock_guard lock(mutex_);
  held_ = false;
  for (auto& end : std::exchange(waiting_, {})) tasks_.push_back(std::move(end));
  changed_.notify_all();
}

void FakeRunner::HoldDecoding() {
  std::lock_guard lock(mutex_);
  decoding_held_ = true;
}

void FakeRunner::Refuse(absl::Status status) {
  std::lock_guard lock(mutex_);
  refusal_ = std::move(status);
}

void FakeRunner::RunShort(uint64_t needed_bytes) {
  std::lock_guard lock(mutex_);
  needed_bytes_ = needed_bytes;
}

void FakeRunner::WaitForComputing(int jobs) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return computing_ >= jobs; });
}

int FakeRunner::started() const {
  std::lock_guard lock(mutex_);
  return started_;
}

uint64_t FakeRunner::min_bytes() const {
  std::lock_guard lock(mutex_);
  return min_bytes_;
}

int FakeRunner::computed() const {
  std::lock_guard lock(mutex_);
  return computed_;
}

}  // namespace bccskel::server
