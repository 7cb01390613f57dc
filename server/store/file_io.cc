#include "server/store/file_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

constexpr int kOwnerFile = 0600;

absl::Status Failed(const char* what, const std::string& path) {
  return SystemError(absl::StrCat("cannot ", what, " ", path), errno);
}

std::string FolderOf(const std::string& path) {
  return std::filesystem::path(path).parent_path().string();
}

constexpr size_t kReadBytes = size_t{1} << 20;

// Marks NOT_FOUND for a file, unlike that for a name of a caller.
constexpr char kMissingFile[] = "bccskel.server/missing-file";

}  // namespace

bool IsMissingFile(const absl::Status& status) {
  return status.GetPayload(kMissingFile).has_value();
}

absl::Status SystemError(const std::string& what, int number) {
  const std::string message = absl::StrCat(what, ": ", std::strerror(number));
  switch (number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return absl::ResourceExhaustedError(message);
    case ENFILE:
    case EMFILE:
      return absl::UnavailableError("too many files are open");
    case ENOENT: {
      absl::Status missing = absl::NotFoundError(message);
      missing.SetPayload(kMissingFile, absl::Cord());
      return missing;
    }
    default:
      return absl::InternalError(message);
  }
}

absl::StatusOr<File> File::Open(const std::string& path, int flags) {
  exec::Descriptor file(open(path.c_str(), flags | O_CLOEXEC, kOwnerFile));
  if (!file.is_open()) return Failed("open", path);
  return File(path, std::move(file));
}

absl::StatusOr<File> File::OpenToRead(const std::string& path) { return Open(path, O_RDONLY); }

absl::StatusOr<File> File::OpenToWrite(const std::string& path) {
  return Open(path, O_RDWR | O_CREAT);
}

absl::StatusOr<File> File::OpenToGoOn(const std::string& path) { return Open(path, O_RDWR); }

absl::StatusOr<uint64_t> File::Size() const {
  struct stat facts = {};
  if (fstat(fd(), &facts) != 0) return Failed("measure", path_);
  return static_cast<uint64_t>(facts.st_size);
}

absl::StatusOr<std::string> File::ReadAt(uint64_t offset, size_t size) const {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t end, Size());
  // A damaged file may name any size.
  std::string bytes(std::min<uint64_t>(size, end - std::min(end, offset)), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got =
        pread(fd(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Failed("read", path_);
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

absl::Status File::WriteAt(uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = pwrite(fd(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return Failed("write", path_);
    bytes.remove_prefix(static_cast<size_t>(put));
    offset += static_cast<uint64_t>(put);
  }
  return absl::OkStatus();
}

absl::Status File::Truncate(uint64_t size) {
  return ftruncate(fd(), static_cast<off_t>(size)) == 0 ? absl::OkStatus() : Failed("cut", path_);
}

absl::Status File::Sync() { return fsync(fd()) == 0 ? absl::OkStatus() : Failed("sync", path_); }

absl::Status MakeFolder(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::create_directories(path, error)) {
    fs::permissions(path, fs::perms::owner_all, error);
    return SyncFolder(FolderOf(path));
  }
  return error ? SystemError(absl::StrCat("cannot make ", path), error.value()) : absl::OkStatus();
}

absl::Status MakeFolderOf(const std::string& file_path) { return MakeFolder(FolderOf(file_path)); }

uint64_t SpaceOf(const std::string& path) {
  std::error_code error;
  const auto space = std::filesystem::space(path, error);
  return error ? 0 : space.available;
}

absl::Status SyncFolder(const std::string& path) {
  const char* const name = path.empty() ? "." : path.c_str();
  const exec::Descriptor folder(open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.is_open()) return Failed("open", path);
  return fsync(folder.get()) == 0 ? absl::OkStatus() : Failed("sync", path);
}

absl::Status SyncFolderOf(const std::string& file_path) { return SyncFolder(FolderOf(file_path)); }

absl::Status RenameDurably(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) return Failed("rename", from);
  return SyncFolder(FolderOf(to));
}

absl::Status RemoveFile(const std::string& path) {
  return unlink(path.c_str()) == 0 || errno == ENOENT ? absl::OkStatus() : Failed("remove", path);
}

absl::StatusOr<FileFacts> FactsOf(const std::string& path) {
  struct stat facts = {};
  if (stat(path.c_str(), &facts) != 0) return Failed("look at", path);
  return FileFacts{.identity = {facts.st_dev, facts.st_ino},
                   .size_bytes = static_cast<uint64_t>(facts.st_size),
                   .written = std::chrono::system_clock::from_time_t(facts.st_mtime)};
}

absl::StatusOr<std::vector<std::string>> FilesBelow(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  std::error_code error;
  if (!fs::exists(path, error)) return files;
  for (auto entry = fs::recursive_directory_iterator(path, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->is_regular_file()) files.push_back(entry->path().string());
  }
  if (error) return SystemError(absl::StrCat("cannot list ", path), error.value());
  return files;
}

absl::StatusOr<CheckedFile> CheckedFile::Open(const std::string& path, const std::string& digest) {
  absl::StatusOr<File> file = File::OpenToRead(path);
  if (file.ok()) return CheckedFile(*std::move(file), digest);
  if (!absl::IsNotFound(file.status())) return file.status();
  return absl::DataLossError(absl::StrCat("the stored file with SHA-256 ", digest, " is missing"));
}

absl::StatusOr<std::string> CheckedFile::Next() {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t size, file_.Size());
  const uint64_t left = size - std::min(size, offset_);
  BCCSKEL_ASSIGN_OR_RETURN(std::string bytes,
                           file_.ReadAt(offset_, std::min<uint64_t>(left, kReadBytes)));
  offset_ += bytes.size();
  sha256_.Add(bytes);
  if (!bytes.empty()) return bytes;
  const std::string found = sha256_.Finish().Hex();
  if (found == digest_) return bytes;
  return absl::DataLossError(absl::StrCat("a stored file of ", offset_,
                                          " bytes is damaged: its SHA-256 is ", found,
                                          ", expected was ", digest_));
}

absl::Status CheckedFile::ReadRest() {
  absl::StatusOr<std::string> bytes = Next();
  while (bytes.ok() && !bytes->empty()) bytes = Next();
  return bytes.status();
}

}  // namespace bccskel::server
