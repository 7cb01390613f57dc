// Any bytes as what the server finds where it stored something: the first byte chooses an error of
// a job, a result's file, the chunks of an unfinished upload, or a row of a table. Whatever is
// read, is whole or an error, never a wrong value that passes for a right one.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/digest/sha256.h"
#include "server/errors/call_error.h"
#include "server/store/file_io.h"
#include "server/store/job_store.h"
#include "server/store/result_file.h"
#include "server/store/stored_bytes.h"
#include "server/store/upload_file.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

// Gone with the process.
const test::TemporaryFolder& Folder() {
  static const test::TemporaryFolder folder;
  return folder;
}

void Write(const std::string& path, std::string_view bytes) {
  auto file = File::OpenToWrite(path);
  Insist(file.ok() && file->Truncate(0).ok() && file->WriteAt(0, bytes).ok());
}

void ReadStatus(const std::string& bytes) {
  const absl::Status status = StatusOfBytes(bytes);
  DetailsOf(status);
  NeededBytesOf(status);
  if (!status.ok()) Insist(!WithJobReason(status).ok() && !WithDiskReason(status).ok());
  // What was read is what is stored again.
  const absl::Status again = StatusOfBytes(BytesOf(status));
  Insist(again == status && ReasonOf(again) == ReasonOf(status));
}

// The digest is that of the bytes: what is damaged is found where it is read.
void ReadResult(const std::string& bytes) {
  const std::string path = Folder() / "result";
  Write(path, bytes);
  const auto file = ResultFile::Open(path, Sha256Of(bytes).Hex());
  if (!file.ok()) return Insist(absl::IsDataLoss(file.status()));
  for (uint64_t record = 0; record < file->records(); ++record) {
    const auto read = file->Read(record);
    Insist(read.ok() ? read->bytes.size() <= bytes.size() : absl::IsDataLoss(read.status()));
  }
  Insist(absl::IsOutOfRange(file->Read(file->records()).status()));
}

// The first half lies where chunks' lengths and checksums do, the rest where their bytes do.
void ReadUpload(const std::string& bytes) {
  const std::string path = Folder() / "upload";
  const size_t half = bytes.size() / 2;
  Write(UploadFile::ChunksPath(path), bytes.substr(0, half));
  Write(UploadFile::BytesPath(path), bytes.substr(half));
  const auto upload = UploadFile::Open(path);
  Insist(upload.ok() && (*upload)->size() <= bytes.size() - half);
  const uint64_t whole = (*upload)->size();
  Insist((*upload)->Append("next").ok() && (*upload)->size() == whole + 4);
  Insist((*UploadFile::Open(path))->size() == whole + 4);
}

// One column of one row holds the bytes, or the number that they begin with.
void ReadRow(const std::string& bytes) {
  static constexpr const char* kColumns[] = {"tenant", "name",     "options",  "error",  "volume",
                                             "owner",  "priority", "attempts", "result", "ended",
                                             "state",  "sequence", "row_check"};
  if (bytes.size() < 2) return;
  const std::string path = Folder() / "jobs.db";
  static const bool made = [&path] {
    const auto store = OpenSqliteJobStore(path);
    Insist(store.ok());
    JobRow job;
    job.tenant = "tenant";
    job.name = "jobs/a";
    return (*store)->InsertJob(job).ok();
  }();
  Insist(made);
  auto database = *OpenSqlite(path);
  const std::string column = kColumns[static_cast<uint8_t>(bytes[0]) % std::size(kColumns)];
  const std::string rest = bytes.substr(2);
  SqlValue value = SqlValue::Blob(rest);
  if (bytes[1] % 3 == 0) value = SqlValue::Text(rest);
  if (bytes[1] % 3 == 1) {
    std::string number = rest;
    number.resize(sizeof(uint64_t));
    value = SqlValue::Number(static_cast<int64_t>(NumberAt<uint64_t>(number, 0)));
  }
  Insist(database->Begin("").ok());
  const bool spoiled = database->Run("UPDATE jobs SET " + column + " = $1", {value}).ok();
  JobStore store(std::move(database));
  const auto found = store.UnfinishedJobs();
  const auto named = store.Find<JobRow>("tenant", "jobs/a");
  // A change that passes is one to what was there before.
  if (spoiled && found.ok() && !found->empty()) {
    Insist(found->front().name == "jobs/a" && found->front().state == JobState::kQueued);
  }
  Insist(named.ok() || absl::IsDataLoss(named.status()));
  store.Rollback();
}

}  // namespace
}  // namespace bccskel::server

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bccskel::server;
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  void (*const readers[])(const std::string&) = {ReadStatus, ReadResult, ReadUpload, ReadRow};
  readers[data[0] % std::size(readers)](bytes);
  return 0;
}
