#ifndef BCCSKEL_TESTS_SERVER_DURABLE_DURABLE_FIXTURE_H_
#define BCCSKEL_TESTS_SERVER_DURABLE_DURABLE_FIXTURE_H_

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/durable/durable_jobs.h"
#include "tests/server/durable/fake_runner.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {

// Remembers what it hears.
class RememberingWatcher final : public JobWatcher {
 public:
  void OnEvent(const JobEvent& event) override {
    std::lock_guard lock(mutex_);
    events_.push_back(event);
    changed_.notify_all();
  }
  void OnWatchEnd(const absl::Status& status) override {
    std::lock_guard lock(mutex_);
    end_ = status;
    changed_.notify_all();
  }
  absl::Status WaitForEnd() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return end_.has_value(); });
    return *end_;
  }
  void WaitForState(JobState state) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return Has(state) || end_.has_value(); });
  }
  std::vector<JobEvent> events() const {
    std::lock_guard lock(mutex_);
    return events_;
  }
  // The states in order, as digits.
  std::string States() const {
    std::string states;
    for (const JobEvent& event : events()) {
      const auto* change = std::get_if<JobEvent::StateChange>(&event.what);
      if (change != nullptr) states += std::to_string(static_cast<int>(change->state));
    }
    return states;
  }

 private:
  bool Has(JobState state) const {
    for (const JobEvent& event : events_) {
      const auto* change = std::get_if<JobEvent::StateChange>(&event.what);
      if (change != nullptr && change->state == state) return true;
    }
    return false;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<JobEvent> events_;
  std::optional<absl::Status> end_;
};

class DurableTest : public testing::Test {
 protected:
  DurableTest() {
    options_.data_directory = folder_ / "data";
    options_.algorithm_version = "1";
    options_.max_clock_leap = std::chrono::hours(10'000);  // of Wait()
    options_.now = [this] { return std::chrono::system_clock::now() + later_.load(); };
  }

  absl::Status TryOpen() {
    auto durable_jobs = DurableJobs::Open(options_, *runner_, codec_);
    if (durable_jobs.ok()) durable_jobs_ = *std::move(durable_jobs);
    return durable_jobs.status();
  }
  void Open() {
    const absl::Status opened = TryOpen();
    ASSERT_TRUE(opened.ok()) << opened;
  }
  void Close() { durable_jobs_.reset(); }
  // As if the process had been killed now: what is on disk is taken over, nothing else. The old
  // DurableJobs goes on in a folder of its own until the test's end.
  void Crash() {
    const std::string copy = folder_ / ("data" + std::to_string(++crashes_));
    std::filesystem::copy(options_.data_directory, copy, std::filesystem::copy_options::recursive);
    killed_.emplace_back(std::move(runner_), std::move(durable_jobs_));
    runner_ = std::make_unique<FakeRunner>();
    options_.data_directory = copy;
  }
  // Lets time pass.
  void Wait(std::chrono::seconds time) { later_ = later_.load() + time; }

  // What the callback is given.
  template <typename Value, typename Call>
  static absl::StatusOr<Value> Get(Call call) {
    std::promise<absl::StatusOr<Value>> promise;
    call([&](absl::StatusOr<Value> value) { promise.set_value(std::move(value)); });
    return promise.get_future().get();
  }
  template <typename Call>
  static absl::Status GetStatus(Call call) {
    std::promise<absl::Status> promise;
    call([&](absl::Status status) { promise.set_value(std::move(status)); });
    return promise.get_future().get();
  }

  void Reopen() {
    Close();
    Open();
  }

  absl::StatusOr<UploadInfo> CreateUpload(const std::string& tenant, const NewUpload& upload) {
    return Get<UploadInfo>([&](auto done) { durable_jobs_->CreateUpload(tenant, upload, done); });
  }
  absl::StatusOr<uint64_t> Append(const std::string& tenant, const std::string& upload,
                                  uint64_t offset, const std::string& bytes,
                                  std::optional<uint32_t> crc32c = std::nullopt) {
    return Get<uint64_t>(
        [&](auto done) { durable_jobs_->Append(tenant, upload, offset, bytes, crc32c, done); });
  }
  absl::StatusOr<UploadInfo> GetUpload(const std::string& tenant, const std::string& upload) {
    return Get<UploadInfo>([&](auto done) { durable_jobs_->GetUpload(tenant, upload, done); });
  }
  absl::StatusOr<VolumeInfo> Finish(const std::string& tenant, const std::string& upload,
                                    uint64_t size,
                                    std::optional<Sha256Digest> sha256 = std::nullopt) {
    return Get<VolumeInfo>(
        [&](auto done) { durable_jobs_->FinishUpload(tenant, upload, size, sha256, done); });
  }
  // A whole upload; the volume's name.
  std::string Upload(const std::string& tenant, const std::string& bytes,
                     const std::string& declaration = "") {
    const auto upload =
        CreateUpload(tenant, {.declaration = std::to_string(bytes.size()) + declaration});
    EXPECT_TRUE(upload.ok()) << upload.status();
    if (!upload.ok()) return {};
    EXPECT_TRUE(Append(tenant, upload->name, 0, bytes).ok());
    const auto volume = Finish(tenant, upload->name, bytes.size());
    EXPECT_TRUE(volume.ok()) << volume.status();
    return volume.ok() ? volume->name : std::string();
  }
  absl::StatusOr<std::vector<VolumeInfo>> Find(const std::string& tenant,
                                               const std::string& digest) {
    return Get<std::vector<VolumeInfo>>(
        [&](auto done) { durable_jobs_->FindVolumes(tenant, {digest}, done); });
  }
  absl::Status DeleteVolume(const std::string& tenant, const std::string& volume) {
    return GetStatus([&](auto done) { durable_jobs_->DeleteVolume(tenant, volume, done); });
  }
  absl::StatusOr<JobInfo> Create(const std::string& tenant, const NewJob& job) {
    return Get<JobInfo>([&](auto done) { durable_jobs_->CreateJob(tenant, job, done); });
  }
  static NewJob JobOf(const std::string& volume, const std::string& options = "o",
                      const std::string& request_id = "") {
    NewJob job;
    job.volume = volume;
    job.options = options;
    job.request_id = request_id;
    return job;
  }
  std::string CreateName(const std::string& tenant, const NewJob& job) {
    const auto info = Create(tenant, job);
    EXPECT_TRUE(info.ok()) << info.status();
    return info.ok() ? info->name : std::string();
  }
  // A job of the clinic on these bytes.
  std::string MakeJob(const std::string& bytes = "volume") {
    return CreateName("clinic", JobOf(Upload("clinic", bytes)));
  }
  std::string EndedJob() {
    const std::string job = MakeJob();
    WaitForEnd("clinic", job);
    return job;
  }
  absl::StatusOr<JobPage> List(const std::string& tenant, const JobQuery& query = {}) {
    return Get<JobPage>([&](auto done) { durable_jobs_->ListJobs(tenant, query, done); });
  }
  absl::StatusOr<JobInfo> GetJob(const std::string& tenant, const std::string& job) {
    return Get<JobInfo>([&](auto done) { durable_jobs_->GetJob(tenant, job, done); });
  }
  absl::StatusOr<JobInfo> Cancel(const std::string& tenant, const std::string& job) {
    return Get<JobInfo>([&](auto done) { durable_jobs_->CancelJob(tenant, job, done); });
  }
  absl::Status Delete(const std::string& tenant, const std::string& job) {
    return GetStatus([&](auto done) { durable_jobs_->DeleteJob(tenant, job, done); });
  }
  // A watcher, and what it is there for as long as.
  std::pair<std::shared_ptr<RememberingWatcher>, std::shared_ptr<void>> Watch(
      const std::string& tenant, const std::string& job, uint64_t after = 0) {
    auto watcher = std::make_shared<RememberingWatcher>();
    return {watcher, durable_jobs_->WatchJob(tenant, job, after, watcher)};
  }
  // All that a watcher hears until the job has ended.
  std::shared_ptr<RememberingWatcher> WatchToTheEnd(const std::string& tenant,
                                                    const std::string& job, uint64_t after = 0) {
    const auto [watcher, handle] = Watch(tenant, job, after);
    const absl::Status end = watcher->WaitForEnd();
    EXPECT_TRUE(end.ok()) << end;
    return watcher;
  }
  JobInfo WaitForEnd(const std::string& tenant, const std::string& job) {
    WatchToTheEnd(tenant, job);
    return *GetJob(tenant, job);
  }
  void WaitForState(const std::string& tenant, const std::string& job, JobState state) {
    const auto [watcher, handle] = Watch(tenant, job);
    watcher->WaitForState(state);
  }
  absl::StatusOr<std::vector<ResultRecord>> ReadResult(const std::string& tenant,
                                                       const std::string& job, uint64_t first = 0) {
    const auto reader = Get<std::shared_ptr<ResultReader>>(
        [&](auto done) { durable_jobs_->OpenResult(tenant, job, first, done); });
    if (!reader.ok()) return reader.status();
    std::vector<ResultRecord> records;
    while (true) {
      auto record = Get<std::optional<ResultRecord>>([&](auto done) { (*reader)->Next(done); });
      if (!record.ok()) return record.status();
      if (!record->has_value()) return records;
      records.push_back(**std::move(record));
    }
  }
  std::vector<std::string> FilesIn(const std::string& kind) const {
    std::vector<std::string> files;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(options_.data_directory)) {
      if (entry.is_regular_file() && entry.path().parent_path().filename() == kind) {
        files.push_back(entry.path().string());
      }
    }
    return files;
  }

  const test::TemporaryFolder folder_;
  DurableOptions options_;
  const FakeCodec codec_;
  std::atomic<std::chrono::seconds> later_ = std::chrono::seconds(0);
  int crashes_ = 0;
  std::vector<std::pair<std::unique_ptr<FakeRunner>, std::unique_ptr<DurableJobs>>> killed_;
  std::unique_ptr<FakeRunner> runner_ = std::make_unique<FakeRunner>();
  std::unique_ptr<DurableJobs> durable_jobs_;  // goes before its runner
};

}  // namespace bccskel::server

#endif  // BCCSKEL_TESTS_SERVER_DURABLE_DURABLE_FIXTURE_H_
