#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>

#include "core/digest/crc32c.h"
#include "server/errors/call_error.h"
#include "server/store/disk_quota.h"
#include "tests/server/durable/durable_fixture.h"

namespace bccskel::server {
namespace {

using testing::IsEmpty, testing::SizeIs;

std::string CommittedSizeIn(const absl::Status& status) {
  const ErrorDetails details = DetailsOf(status);
  EXPECT_EQ(details.key, "committed_size");
  return details.value;
}

class DurableUploadsTest : public DurableTest {
 protected:
  void SetUp() override { Open(); }

  std::string Begin(const std::string& tenant, const std::string& name, uint64_t size) {
    const auto upload = CreateUpload(tenant, {.name = name, .declaration = std::to_string(size)});
    EXPECT_TRUE(upload.ok()) << upload.status();
    return upload.ok() ? upload->name : std::string();
  }
  UploadInfo BeginWithJob(const std::string& name, uint64_t size) {
    const auto info = CreateUpload("clinic", {.name = name,
                                              .declaration = std::to_string(size),
                                              .then_job = NewUpload::ThenJob{.options = "o"}});
    EXPECT_TRUE(info.ok()) << info.status();
    return *info;
  }
};

TEST_F(DurableUploadsTest, MakesAVolumeOfChunksInOrder) {
  const std::string upload = Begin("clinic", "uploads/mine", 10);
  EXPECT_EQ(upload, "uploads/mine");
  EXPECT_EQ(*Append("clinic", upload, 0, "12345", Crc32c("12345")), 5u);
  EXPECT_EQ(*Append("clinic", upload, 5, "67890"), 10u);
  const auto volume = Finish("clinic", upload, 10, Sha256Of("1234567890"));
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_EQ(volume->blob_digest, Sha256Of("1234567890").Hex());
  EXPECT_THAT(*Find("clinic", volume->blob_digest), SizeIs(1));
  EXPECT_EQ(Finish("clinic", upload, 10)->name, volume->name) << "finishing again";
  const absl::Status other = Finish("clinic", upload, 10, Sha256Of("0987654321")).status();
  EXPECT_EQ(ReasonOf(other), Reason::kVolumeInvalid) << "these are other bytes";
  EXPECT_EQ(GetUpload("clinic", upload)->volume, volume->name);
  EXPECT_THAT(FilesIn("uploads"), IsEmpty());
  EXPECT_THAT(FilesIn("blobs"), SizeIs(1));
}

TEST_F(DurableUploadsTest, TellsWhereToGoOnAfterAWrongOffset) {
  const std::string upload = Begin("clinic", "", 10);
  ASSERT_TRUE(Append("clinic", upload, 0, "123").ok());
  const absl::Status wrong = Append("clinic", upload, 5, "45").status();
  EXPECT_EQ(wrong.code(), absl::StatusCode::kOutOfRange);
  EXPECT_EQ(CommittedSizeIn(wrong), "3");
  EXPECT_EQ(CommittedSizeIn(Append("clinic", upload, 3, "12345678").status()), "3") << "too much";
  EXPECT_EQ(CommittedSizeIn(Finish("clinic", upload, 10).status()), "3") << "bytes are missing";
  EXPECT_EQ(ReasonOf(Finish("clinic", upload, 3).status()), Reason::kVolumeSize);
}

TEST_F(DurableUploadsTest, RefusesAChunkWithAnotherChecksumAndKeepsTheRest) {
  const std::string upload = Begin("clinic", "", 10);
  ASSERT_TRUE(Append("clinic", upload, 0, "123").ok());
  const absl::Status wrong = Append("clinic", upload, 3, "456", Crc32c("457")).status();
  EXPECT_EQ(ReasonOf(wrong), Reason::kChunkChecksum);
  EXPECT_EQ(GetUpload("clinic", upload)->committed_bytes, 3u);
}

TEST_F(DurableUploadsTest, NamesNoFileThatIsGone) {
  const auto upload = CreateUpload("clinic", {.declaration = "9"});
  for (const std::string& file : FilesIn("uploads")) std::filesystem::remove(file);
  const absl::Status status = Append("clinic", upload->name, 0, "x").status();
  EXPECT_EQ(status, absl::NotFoundError("there is no upload " + upload->name));
}

TEST_F(DurableUploadsTest, LetsOneWriterWriteAtATime) {
  runner_->HoldDecoding();
  const UploadInfo upload = BeginWithJob("uploads/a", 10);
  std::promise<absl::StatusOr<uint64_t>> first;
  durable_jobs_->Append("clinic", upload.name, 0, "123", std::nullopt,
                        [&](absl::StatusOr<uint64_t> done) { first.set_value(std::move(done)); });
  EXPECT_EQ(Append("clinic", upload.name, 0, "123").status().code(), absl::StatusCode::kAborted);
  EXPECT_EQ(Finish("clinic", upload.name, 10).status().code(), absl::StatusCode::kAborted);
  durable_jobs_->SenderGone("clinic", upload.name);
  EXPECT_EQ(*first.get_future().get(), 3u) << "the bytes are here, whoever decodes them";
  EXPECT_TRUE(Append("clinic", upload.name, 3, "4").ok());
}

TEST_F(DurableUploadsTest, GoesOnAfterACrash) {
  const std::string upload = Begin("clinic", "uploads/a", 10);
  ASSERT_TRUE(Append("clinic", upload, 0, "1234").ok());
  Crash();
  Open();
  EXPECT_EQ(GetUpload("clinic", upload)->committed_bytes, 4u);
  ASSERT_TRUE(Append("clinic", upload, 4, "567890").ok());
  EXPECT_EQ(Finish("clinic", upload, 10)->blob_digest, Sha256Of("1234567890").Hex());
}

TEST_F(DurableUploadsTest, BeginsTheSameUploadOnce) {
  Begin("clinic", "uploads/a", 10);
  ASSERT_TRUE(Append("clinic", "uploads/a", 0, "1234").ok());
  const auto again = CreateUpload("clinic", {.name = "uploads/a", .declaration = "10"});
  EXPECT_EQ(again->committed_bytes, 4u);
  const auto other = CreateUpload("clinic", {.name = "uploads/a", .declaration = "11"});
  EXPECT_EQ(other.status().code(), absl::StatusCode::kAlreadyExists);
  EXPECT_EQ(Append("clinic", "uploads/a", 4, "567890").value_or(0), 10u) << "it goes on";
  Begin("other", "uploads/a", 11);
}

TEST_F(DurableUploadsTest, RefusesBadNamesAndDeclarations) {
  for (const char* name : {"x", "uploads/", "uploads/a/b", "uploads/..", "uploads/\n"}) {
    EXPECT_EQ(CreateUpload("clinic", {.name = name, .declaration = "1"}).status().code(),
              absl::StatusCode::kInvalidArgument)
        << name;
  }
  EXPECT_EQ(CreateUpload("clinic", {.declaration = "?"}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST_F(DurableUploadsTest, DropsAnUploadWithAnotherDigestThanStated) {
  const std::string upload = Begin("clinic", "", 4);
  ASSERT_TRUE(Append("clinic", upload, 0, "1234").ok());
  EXPECT_EQ(ReasonOf(Finish("clinic", upload, 4, Sha256Of("1235")).status()),
            Reason::kVolumeInvalid);
  EXPECT_EQ(GetUpload("clinic", upload).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(FilesIn("uploads"), IsEmpty());
}

TEST_F(DurableUploadsTest, HidesEverythingFromOtherTenants) {
  const std::string upload = Begin("clinic", "uploads/a", 4);
  EXPECT_EQ(Append("other", upload, 0, "1234").status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(GetUpload("other", upload).status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(Finish("other", upload, 4).status().code(), absl::StatusCode::kNotFound);
  const std::string volume = Upload("clinic", "same");
  EXPECT_THAT(*Find("other", Sha256Of("same").Hex()), IsEmpty());
  EXPECT_EQ(Upload("other", "same"), volume) << "names say nothing but the content";
  EXPECT_THAT(FilesIn("blobs"), SizeIs(2)) << "yet each has its own bytes";
  EXPECT_TRUE(DeleteVolume("other", volume).ok());
  EXPECT_THAT(*Find("clinic", Sha256Of("same").Hex()), SizeIs(1));
}

TEST_F(DurableUploadsTest, ErasesTheBytesOfADeletedVolumeUnlessAnotherHasThem) {
  const std::string one = Upload("clinic", "same", " one"), two = Upload("clinic", "same", " two");
  EXPECT_NE(one, two);
  EXPECT_THAT(FilesIn("blobs"), SizeIs(1));
  EXPECT_TRUE(DeleteVolume("clinic", one).ok());
  EXPECT_THAT(FilesIn("blobs"), SizeIs(1));
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 4u);
  EXPECT_TRUE(DeleteVolume("clinic", two).ok());
  EXPECT_THAT(FilesIn("blobs"), IsEmpty());
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 0u);
}

TEST_F(DurableUploadsTest, GivesTheBytesOfVolumesThatExpireTogetherBackOnce) {
  Upload("clinic", "same", " one");
  Upload("clinic", "same", " two");
  Wait(std::chrono::hours(2));
  Upload("clinic", "newer!");
  Wait(std::chrono::hours(23));
  for (int n = 0; n < 10'000 && FilesIn("blobs").size() > 1; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_THAT(FilesIn("blobs"), SizeIs(1));
  EXPECT_TRUE(List("clinic").ok()) << "waits for what the server is doing";
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 6u);
}

TEST_F(DurableUploadsTest, CountsUploadsByTheirDeclaredSize) {
  Close();
  options_.max_disk_bytes = 100;
  options_.max_tenant_disk_bytes = 60;
  Open();
  Begin("clinic", "uploads/a", 50);
  const absl::Status own = CreateUpload("clinic", {.declaration = "11"}).status();
  EXPECT_EQ(own.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(DetailsOf(own).quota, "max_tenant_disk_bytes");
  EXPECT_EQ(DetailsOf(CreateUpload("other", {.declaration = "51"}).status()).quota,
            "max_disk_bytes");
  EXPECT_TRUE(
      GetStatus([&](auto done) { durable_jobs_->DeleteUpload("clinic", "uploads/a", done); }).ok());
  Begin("clinic", "", 60);
}

TEST_F(DurableUploadsTest, ForgetsUploadsAndVolumesThatNobodyUses) {
  Begin("clinic", "uploads/a", 4);
  const UploadInfo receiving = BeginWithJob("uploads/b", 4);
  Upload("clinic", "volume");
  Wait(std::chrono::hours(25));
  const JobInfo job = WaitForEnd("clinic", receiving.job);
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.error.code(), absl::StatusCode::kDeadlineExceeded);
  Reopen();  // cleans up what is left
  EXPECT_EQ(GetUpload("clinic", "uploads/a").status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(FilesIn("uploads"), IsEmpty());
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 0u);
}

TEST_F(DurableUploadsTest, RunsAJobWithItsUploadAsSoonAsItIsComplete) {
  const UploadInfo upload = BeginWithJob("uploads/a", 6);
  EXPECT_EQ(GetJob("clinic", upload.job)->state, JobState::kReceiving);
  ASSERT_TRUE(Append("clinic", upload.name, 0, "vol").ok());
  ASSERT_TRUE(Append("clinic", upload.name, 3, "ume").ok());
  ASSERT_TRUE(Finish("clinic", upload.name, 6).ok());
  const JobInfo job = WaitForEnd("clinic", upload.job);
  EXPECT_EQ(job.state, JobState::kSucceeded) << job.error;
  EXPECT_EQ(job.attempts, 1);
  EXPECT_EQ(runner_->started(), 1) << "it was decoded while it came";
  EXPECT_EQ(job.summary, "summary of volume");
}

TEST_F(DurableUploadsTest, RunsAJobFromItsFileWhenTheSenderWasGoneMeanwhile) {
  const UploadInfo upload = BeginWithJob("uploads/a", 6);
  ASSERT_TRUE(Append("clinic", upload.name, 0, "vol").ok());
  durable_jobs_->SenderGone("clinic", upload.name);
  ASSERT_TRUE(Append("clinic", upload.name, 3, "ume").ok());
  ASSERT_TRUE(Finish("clinic", upload.name, 6).ok());
  EXPECT_EQ(WaitForEnd("clinic", upload.job).summary, "summary of volume");
  EXPECT_EQ(runner_->started(), 2);
}

TEST_F(DurableUploadsTest, KeepsAJobThatIsReceivedOverACrash) {
  const UploadInfo upload = BeginWithJob("uploads/a", 6);
  ASSERT_TRUE(Append("clinic", upload.name, 0, "vol").ok());
  Crash();
  Open();
  EXPECT_EQ(GetJob("clinic", upload.job)->state, JobState::kReceiving);
  ASSERT_TRUE(Append("clinic", upload.name, 3, "ume").ok());
  ASSERT_TRUE(Finish("clinic", upload.name, 6).ok());
  EXPECT_EQ(WaitForEnd("clinic", upload.job).summary, "summary of volume");
}

TEST_F(DurableUploadsTest, EndsAJobWhoseVolumeIsMalformed) {
  const UploadInfo upload = BeginWithJob("uploads/a", 6);
  EXPECT_EQ(Append("clinic", upload.name, 0, "vo!").status().code(),
            absl::StatusCode::kInvalidArgument);
  const JobInfo job = WaitForEnd("clinic", upload.job);
  EXPECT_EQ(job.state, JobState::kFailed);
  EXPECT_EQ(job.error.message(), "the volume is malformed");
  EXPECT_EQ(GetUpload("clinic", upload.name).status().code(), absl::StatusCode::kNotFound);
}

TEST_F(DurableUploadsTest, TellsTheRunnersRefusalBeforeAnythingIsStored) {
  runner_->Refuse(CallError(Reason::kQueueFull, "full"));
  const NewUpload upload = {
      .name = "uploads/a", .declaration = "6", .then_job = NewUpload::ThenJob{.options = {}}};
  EXPECT_EQ(ReasonOf(CreateUpload("clinic", upload).status()), Reason::kQueueFull);
  EXPECT_EQ(GetUpload("clinic", "uploads/a").status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 0u);
}

TEST_F(DurableUploadsTest, CancelsAJobThatIsReceivedAndTakesItsUploadAway) {
  const UploadInfo upload = BeginWithJob("uploads/a", 6);
  ASSERT_TRUE(Append("clinic", upload.name, 0, "vol").ok());
  EXPECT_EQ(Cancel("clinic", upload.job)->state, JobState::kCancelled);
  EXPECT_EQ(GetUpload("clinic", upload.name).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(FilesIn("uploads"), IsEmpty());
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 0u);
}

TEST_F(DurableUploadsTest, LetsOneProcessOwnTheDirectory) {
  FakeRunner runner;
  EXPECT_EQ(DurableJobs::Open(options_, runner, codec_).status().code(),
            absl::StatusCode::kAlreadyExists);
}

TEST_F(DurableUploadsTest, AdmitsNothingNewOnceItIsToStop) {
  const std::string volume = Upload("clinic", "volume");
  durable_jobs_->StopAdmitting();
  EXPECT_EQ(ReasonOf(Create("clinic", JobOf(volume)).status()), Reason::kDraining);
  EXPECT_EQ(ReasonOf(CreateUpload("clinic", {.declaration = "1"}).status()), Reason::kDraining);
}

}  // namespace
}  // namespace bccskel::server
