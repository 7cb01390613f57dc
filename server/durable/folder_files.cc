#include "server/durable/folder_files.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

absl::Status UnknownData(const std::string& folder, size_t files) {
  return absl::FailedPreconditionError(absl::StrCat(
      folder, " holds ", files, " files of uploads, volumes and results that its jobs.db does not ",
      "know: that is missing, empty or from elsewhere. Nothing was changed. Restore the "
      "jobs.db ",
      "that belongs to them, or start once with --unknown-data adopt to continue without it: "
      "files ",
      "that no table names are then removed at the first start after a day"));
}

}  // namespace

absl::Status FolderFiles::CheckTables(const std::string& tables, const DurableOptions& options) {
  if (options.unknown_data == "adopt") return absl::OkStatus();
  if (LacksItsLog(tables)) {
    return absl::FailedPreconditionError(absl::StrCat(
        tables, "-wal is missing, which holds the last changes of ", tables,
        ": the server that made them did not end in good order. Nothing was changed. Restore the "
        "file, or start once with --unknown-data adopt to continue without those changes"));
  }
  const auto facts = FactsOf(tables);
  if (facts.ok() && facts->size_bytes > 0) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const auto files, BlobStore(options.data_directory).Files());
  return files.empty() ? absl::OkStatus() : UnknownData(options.data_directory, files.size());
}

absl::StatusOr<std::set<std::string>> FolderFiles::Known(JobStore& store) const {
  std::set<std::string> known;
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<UploadRow> uploads, store.All<UploadRow>());
  for (const UploadRow& row : uploads) {
    if (!row.volume.empty()) continue;
    known.insert(UploadFile::BytesPath(blobs_.PathOf(row)));
    known.insert(UploadFile::ChunksPath(blobs_.PathOf(row)));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<VolumeRow> volumes, store.All<VolumeRow>());
  for (const VolumeRow& row : volumes) known.insert(blobs_.PathOfBlob(row.tenant, row.blob_digest));
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<ResultRow> results, store.All<ResultRow>());
  for (const ResultRow& row : results) {
    if (row.file.empty()) continue;
    const std::string path = blobs_.PathOfResult(row.tenant, row.file);
    known.insert(path);
    if (store.shared()) known.insert(path + kUnconfirmed);
    // A crash may have prevented the confirmation. A lost file is reported when it is read.
    if (!store.shared()) blobs_.ConfirmResult(row.tenant, row.file).IgnoreError();
  }
  return known;
}

// Files of another job store must not be swept. A folder whose lock was deleted does not name its
// store; for it one known file is enough.
absl::Status FolderFiles::TakeOver(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::set<std::string> known, Known(store));
  BCCSKEL_ASSIGN_OR_RETURN(const std::set<std::string> files, blobs_.Files());
  BCCSKEL_ASSIGN_OR_RETURN(const std::string id, store.Id());
  if (lock_.store_id() == id) {
    SweepAtStart(store, files, known);
    return absl::OkStatus();
  }
  const auto is_known = [&known](const std::string& file) { return known.count(file) > 0; };
  // If all files are known, only the lock is damaged.
  const bool strange = !std::ranges::all_of(files, is_known) &&
                       (!lock_.store_id().empty() || std::ranges::none_of(files, is_known));
  if (strange && options_.unknown_data != "adopt") {
    return UnknownData(options_.data_directory, files.size());
  }
  if (!strange && !files.empty() && !lock_.store_id().empty()) {
    options_.on_warning(absl::StrCat(options_.data_directory, "/lock was damaged and is repaired: ",
                                     "the job store knows all files"));
  }
  return lock_.SetStoreId(id);
}

absl::Status FolderFiles::Join(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string id, store.Id());
  if (lock_.store_id() == id) return absl::OkStatus();
  if (!lock_.store_id().empty()) {
    return absl::FailedPreconditionError(
        absl::StrCat(options_.data_directory,
                     " belongs to another job store than this one: nothing was changed"));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const auto files, blobs_.Files());
  if (!files.empty() && options_.unknown_data != "adopt") {
    return absl::FailedPreconditionError(
        absl::StrCat(options_.data_directory, " holds ", files.size(),
                     " files that this job store does not know: nothing was changed. Use an "
                     "empty folder, or start once with --unknown-data adopt"));
  }
  return lock_.SetStoreId(id);
}

// Sweeps only old files that certainly belong to no row: while a named file is missing or a row is
// unreadable, an unknown file may belong to it.
void FolderFiles::SweepAtStart(JobStore& store, const std::set<std::string>& files,
                               const std::set<std::string>& known) const {
  const bool certain = store.damaged_rows() == 0 && std::ranges::includes(files, known);
  const std::set<std::string> old = OldFiles();
  int kept = 0;
  for (const std::string& file : files) {
    if (known.contains(file)) continue;
    const bool may_go = certain && (file.ends_with(kUnconfirmed) || old.contains(file));
    if (!may_go || !RemoveFile(file).ok()) ++kept;
  }
  if (kept == 0) return;
  options_.on_warning(absl::StrCat(
      kept, " files below ", options_.data_directory, " are named by no table and were kept",
      certain ? "; they are deleted when they are a day old"
              : ": files that are named are missing, or rows are damaged"));
}

std::set<std::string> FolderFiles::OldFiles() const {
  const Time oldest = options_.now() - options_.keep_unknown;
  const auto files = blobs_.Files();
  std::set<std::string> old;
  for (const std::string& file : files.ok() ? *files : std::set<std::string>()) {
    const auto facts = FactsOf(file);
    if (facts.ok() && facts->written < oldest) old.insert(file);
  }
  return old;
}

absl::Status FolderFiles::Sweep(JobStore& store, const std::set<std::string>& old) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::set<std::string> known, Known(store));
  if (store.damaged_rows() > 0) return absl::OkStatus();
  for (const std::string& file : old) {
    if (!known.contains(file)) RemoveFile(file).IgnoreError();
  }
  return absl::OkStatus();
}

absl::Status FolderFiles::RemoveDeleted(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<RemovalRow> removals, store.All<RemovalRow>());
  for (const RemovalRow& row : removals) {
    const absl::Status removed = Remove(store, row);
    if (removed.ok()) BCCSKEL_RETURN_IF_ERROR(store.DeleteRemoval(row));
  }
  return absl::OkStatus();
}

// Deletes the file unless it is in use again.
absl::Status FolderFiles::Remove(JobStore& store, const RemovalRow& row) const {
  switch (row.kind) {
    case RemovalRow::Kind::kUpload:
      return UploadFile::Remove(blobs_.PathOfUpload(row.tenant, row.name));
    case RemovalRow::Kind::kBlob: {
      BCCSKEL_ASSIGN_OR_RETURN(const auto again, store.FindVolumesOf(row.tenant, row.name));
      return again.empty() ? RemoveFile(blobs_.PathOfBlob(row.tenant, row.name)) : absl::OkStatus();
    }
    case RemovalRow::Kind::kResult:
      break;
  }
  return blobs_.RemoveResult(row.tenant, row.name);
}

}  // namespace bccskel::server
