#include "server/store/blob_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "server/errors/call_error.h"
#include "server/store/data_folder.h"
#include "server/store/disk_quota.h"
#include "server/store/upload_file.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr;

std::string Message(const absl::Status& status) { return std::string(status.message()); }

std::string ReadAll(CheckedFile& file) {
  std::string all;
  while (true) {
    const auto bytes = file.Next();
    EXPECT_TRUE(bytes.ok()) << bytes.status();
    if (!bytes.ok() || bytes->empty()) return all;
    all += *bytes;
  }
}

void FlipABit(const std::string& path, uint64_t offset) {
  auto file = *File::OpenToWrite(path);
  std::string byte = *file.ReadAt(offset, 1);
  byte[0] = static_cast<char>(byte[0] ^ 4);
  ASSERT_TRUE(file.WriteAt(offset, byte).ok());
}

class BlobStoreTest : public testing::Test {
 protected:
  absl::StatusOr<std::unique_ptr<UploadFile>> OpenUpload(const std::string& tenant = "clinic",
                                                         const std::string& file = "upload") {
    return UploadFile::Open(blobs_.PathOfUpload(tenant, file));
  }
  std::string StoreBlob(const std::string& tenant, const std::string& bytes) {
    UploadRow row;
    row.tenant = tenant;
    row.file = "upload";
    auto upload = *OpenUpload(tenant);
    EXPECT_TRUE(upload->Append(bytes).ok());
    const std::string digest = upload->Seal()->Hex();
    EXPECT_TRUE(blobs_.PublishBlob(row, digest).ok());
    EXPECT_TRUE(UploadFile::Remove(blobs_.PathOf(row)).ok());
    return digest;
  }
  absl::StatusOr<CheckedFile> OpenBlob(const std::string& tenant, const std::string& digest) {
    return CheckedFile::Open(blobs_.PathOfBlob(tenant, digest), digest);
  }
  std::string UploadPath() const { return blobs_.PathOfUpload("clinic", "upload"); }
  std::string BytesPath() const { return UploadFile::BytesPath(UploadPath()); }
  std::string ChunksPath() const { return UploadFile::ChunksPath(UploadPath()); }

  test::TemporaryFolder folder_;
  const BlobStore blobs_{folder_.path()};
};

TEST_F(BlobStoreTest, GoesOnWithAnUploadAndFindsTheDigestOfAllOfIt) {
  (void)(*OpenUpload())->Append("first ");
  auto upload = *OpenUpload();
  EXPECT_EQ(upload->size(), 6u);
  ASSERT_TRUE(upload->Append("second").ok());
  EXPECT_EQ(*upload->Seal(), Sha256Of("first second"));
}

TEST_F(BlobStoreTest, DropsAChunkThatDidNotReachTheDiskWhole) {
  for (const std::string chunk : {"first ", "second "}) {
    ASSERT_TRUE((*OpenUpload())->Append(chunk).ok());
  }
  // As a crash of the machine may leave it: the length is there, the bytes are not.
  FlipABit(BytesPath(), 8);
  auto upload = *OpenUpload();
  EXPECT_EQ(upload->size(), 6u);
  ASSERT_TRUE(upload->Append("again").ok());
  EXPECT_EQ(*upload->Seal(), Sha256Of("first again"));
}

TEST_F(BlobStoreTest, DropsAChunkWithoutAnEntry) {
  ASSERT_TRUE((*OpenUpload())->Append("first ").ok());
  ASSERT_TRUE((*File::OpenToWrite(BytesPath())).WriteAt(6, "half of a chu").ok());
  ASSERT_TRUE((*File::OpenToWrite(ChunksPath())).WriteAt(12, "half").ok());
  EXPECT_EQ((*OpenUpload())->size(), 6u);
}

TEST_F(BlobStoreTest, KeepsNoFileOfAnUploadOpen) {
  namespace fs = std::filesystem;
  const auto open_files = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = open_files();
  auto upload = *OpenUpload();
  ASSERT_TRUE(upload->Append("first ").ok());
  EXPECT_EQ(open_files(), before);
}

TEST_F(BlobStoreTest, DoesNotBringBackAnUploadThatWasRemoved) {
  auto upload = *OpenUpload();
  ASSERT_TRUE(UploadFile::Remove(UploadPath()).ok());
  EXPECT_TRUE(absl::IsNotFound(upload->Append("late")));
  EXPECT_TRUE(absl::IsNotFound(upload->Seal().status()));
  EXPECT_TRUE(FilesBelow(folder_.path())->empty());
}

TEST_F(BlobStoreTest, ReadsBackWhatWasStored) {
  const std::string bytes(3'000'000, 'v');
  const std::string digest = StoreBlob("clinic", bytes);
  auto blob = OpenBlob("clinic", digest);
  ASSERT_TRUE(blob.ok()) << blob.status();
  EXPECT_EQ(ReadAll(*blob), bytes);
}

TEST_F(BlobStoreTest, TellsAFlippedBitOfABlobWithBothDigests) {
  const std::string digest = StoreBlob("clinic", std::string(2'000'000, 'v'));
  FlipABit(blobs_.PathOfBlob("clinic", digest), 1'500'000);
  auto blob = *OpenBlob("clinic", digest);
  absl::Status status;
  while (status.ok()) {
    const auto bytes = blob.Next();
    ASSERT_TRUE(!bytes.ok() || !bytes->empty()) << "the damage was not seen";
    status = bytes.status();
  }
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(Message(status), HasSubstr(digest));
  EXPECT_THAT(Message(status), HasSubstr("its SHA-256 is"));
}

TEST_F(BlobStoreTest, HealsADamagedBlobWhenItComesAgain) {
  const std::string digest = StoreBlob("clinic", "volume");
  FlipABit(blobs_.PathOfBlob("clinic", digest), 1);
  EXPECT_EQ(StoreBlob("clinic", "volume"), digest);
  auto blob = *OpenBlob("clinic", digest);
  EXPECT_EQ(ReadAll(blob), "volume");
}

TEST_F(BlobStoreTest, HidesTheBlobsOfOneTenantFromAnother) {
  const std::string digest = StoreBlob("clinic", "volume");
  EXPECT_EQ(OpenBlob("other", digest).status().code(), absl::StatusCode::kDataLoss);
  ASSERT_TRUE(RemoveFile(blobs_.PathOfBlob("other", digest)).ok());
  EXPECT_TRUE(OpenBlob("clinic", digest).ok());
}

TEST_F(BlobStoreTest, KeepsHostileNamesInsideItsFolder) {
  ASSERT_TRUE(OpenUpload("../../tenant").ok());
  const std::vector<std::string> files = *FilesBelow(folder_.path());
  for (const std::string& file : files) {
    EXPECT_EQ(file.find(".."), std::string::npos) << file;
  }
  EXPECT_EQ(files.size(), 2u);
}

TEST_F(BlobStoreTest, ReadsAResultFromAnyRecordOn) {
  auto writer = *blobs_.NewResult("clinic", "result");
  for (int n = 0; n < 5; ++n) {
    ASSERT_TRUE(writer.Add(static_cast<uint8_t>(n), std::string(static_cast<size_t>(n), 'r')).ok());
  }
  const std::string digest = writer.Finish()->Hex();
  EXPECT_TRUE(blobs_.OpenResult("clinic", "result", digest).ok()) << "asked for, so it is stored";
  ASSERT_TRUE(blobs_.ConfirmResult("clinic", "result").ok());
  ASSERT_TRUE(blobs_.ConfirmResult("clinic", "result").ok());
  const auto result = blobs_.OpenResult("clinic", "result", digest);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->records(), 5u);
  EXPECT_EQ(result->Read(4)->bytes, "rrrr");
  EXPECT_EQ(result->Read(2)->kind, 2);
  EXPECT_EQ(result->Read(5).status().code(), absl::StatusCode::kOutOfRange);
}

TEST_F(BlobStoreTest, TellsAFlippedBitOfAResultWhereverItIs) {
  auto writer = *blobs_.NewResult("clinic", "result");
  ASSERT_TRUE(writer.Add(1, "record").ok());
  const std::string digest = writer.Finish()->Hex();
  ASSERT_TRUE(blobs_.ConfirmResult("clinic", "result").ok());
  const std::string path = blobs_.PathOfResult("clinic", "result");
  const uint64_t size = *File::OpenToRead(path)->Size();
  for (uint64_t offset = 0; offset < size; ++offset) {
    FlipABit(path, offset);
    EXPECT_EQ(blobs_.OpenResult("clinic", "result", digest).status().code(),
              absl::StatusCode::kDataLoss)
        << offset;
    FlipABit(path, offset);
  }
  EXPECT_TRUE(blobs_.OpenResult("clinic", "result", digest).ok());
}

TEST_F(BlobStoreTest, KnowsWhichBlobsThereAreAndHowLargeTheyShouldBe) {
  EXPECT_TRUE(blobs_.Files()->empty());
  const std::string digest = StoreBlob("clinic", "volume");
  EXPECT_EQ(*blobs_.Files(), std::set<std::string>{blobs_.PathOfBlob("clinic", digest)});
  EXPECT_TRUE(blobs_.HasBlob("clinic", digest, 6));
  EXPECT_FALSE(blobs_.HasBlob("clinic", digest, 7));
  EXPECT_FALSE(blobs_.HasBlob("other", digest, 6));
}

// In a child, for the limit holds for the whole process.
TEST_F(BlobStoreTest, LeavesAnUploadAsItWasWhenTheDiskIsFull) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    auto upload = *OpenUpload();
    bool good = upload->Append(std::string(100'000, 'a')).ok();
    const rlimit limit = {150'000, 150'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const absl::Status full = upload->Append(std::string(100'000, 'b'));
    good = good && absl::IsResourceExhausted(full) && upload->size() == 100'000;
    good = good && upload->Append(std::string(50'000, 'c')).ok();
    good =
        good && *upload->Seal() == Sha256Of(std::string(100'000, 'a') + std::string(50'000, 'c'));
    _exit(good ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(DiskQuotaTest, RefusesWhatIsOverATenantsLimitAndOverThatOfAll) {
  DiskQuota quota(100, 60);
  ASSERT_TRUE(quota.Take("clinic", 60).ok());
  const absl::Status own = quota.Take("clinic", 1);
  EXPECT_EQ(own.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(DetailsOf(own).quota, "max_tenant_disk_bytes");
  EXPECT_THAT(Message(own), HasSubstr("60 are in use, the limit is 60"));
  const absl::Status all = quota.Take("other", 41);
  EXPECT_EQ(DetailsOf(all).quota, "max_disk_bytes");
  EXPECT_EQ(Message(all).find("60"), std::string::npos) << "tells of other tenants";
  EXPECT_TRUE(quota.Take("other", 40).ok());
  quota.GiveBack("clinic", 60);
  EXPECT_EQ(quota.used(), 40u);
  EXPECT_TRUE(quota.Take("clinic", 60).ok());
}

TEST(DiskQuotaTest, DoesNotWrapAround) {
  DiskQuota quota(100, 0);
  ASSERT_TRUE(quota.Take("clinic", 50).ok());
  EXPECT_FALSE(quota.Take("clinic", ~uint64_t{0}).ok());
  EXPECT_EQ(quota.used(), 50u);
}

TEST(FolderLockTest, LetsOneProcessHaveTheFolder) {
  const test::TemporaryFolder folder;
  {
    const auto lock = FolderLock::Take(folder.path());
    ASSERT_TRUE(lock.ok());
    EXPECT_EQ(FolderLock::Take(folder.path()).status().code(), absl::StatusCode::kAlreadyExists);
  }
  EXPECT_TRUE(FolderLock::Take(folder.path()).ok());
}

TEST(FolderLockTest, HoldsTheFolderWhenItsFileIsRemoved) {
  using With = FolderLock::With;
  for (const With with : {With::kNobody, With::kOthers}) {
    const test::TemporaryFolder folder;
    const auto lock = FolderLock::Take(folder.path(), with);
    ASSERT_TRUE(RemoveFile(folder / "lock").ok());
    EXPECT_EQ(FolderLock::Take(folder.path()).status().code(), absl::StatusCode::kAlreadyExists);
    EXPECT_EQ(FolderLock::Take(folder.path(), With::kOthers).ok(), with == With::kOthers);
  }
}

}  // namespace
}  // namespace bccskel::server
