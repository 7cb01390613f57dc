#include "core/io/file_replacement.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

absl::Status SystemStatus(int error) {
  return absl::Status(absl::ErrnoToStatusCode(error), std::generic_category().message(error));
}

absl::Status Stopped() { return absl::CancelledError("interrupted, so it was not written"); }

absl::Status CreationStatus(int error, const std::string& path) {
  const std::string folder = path.substr(0, path.rfind('/') + 1);
  std::error_code ignored;
  if (error != ENOENT || folder.empty() || std::filesystem::exists(folder, ignored)) {
    return SystemStatus(error);
  }
  return absl::NotFoundError(absl::StrFormat("the folder %s does not exist; create it first",
                                             folder.substr(0, folder.size() - 1)));
}

bool IsFolder(const std::string& path) {
  struct stat about;
  return ::stat(path.c_str(), &about) == 0 && S_ISDIR(about.st_mode);
}

bool IsSpecialFile(const std::string& path) {
  struct stat about;
  return ::stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode);
}

bool IsPipe(const std::string& path) {
  struct stat about;
  return ::stat(path.c_str(), &about) == 0 && S_ISFIFO(about.st_mode);
}

// Waits for the reader of a pipe as open() does, but only until a stop request. Tries again and
// again, since nothing reports that a reader has come.
exec::Descriptor OpenSpecial(const std::string& path, const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kPause(10);
  if (!IsPipe(path)) return exec::Descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  const auto open = [&] { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK); };
  exec::Descriptor pipe(open());
  while (!pipe.is_open() && errno == ENXIO && !stop.stop_requested()) {
    std::this_thread::sleep_for(kPause);
    pipe = exec::Descriptor(open());
  }
  if (pipe.is_open()) ::fcntl(pipe.get(), F_SETFL, 0);  // write() is to wait
  return pipe;
}

bool IsNameTooLong(const std::string& path) {
  return ::access(path.c_str(), F_OK) != 0 && errno == ENAMETOOLONG;
}

// Follows links, so that a link stays and its target is replaced or made.
std::string BehindLinks(const std::string& path) {
  constexpr int kMostLinks = 40;  // as the system
  std::filesystem::path place = path;
  std::error_code error;
  for (int n = 0; std::filesystem::is_symlink(place, error); ++n) {
    if (n == kMostLinks) return path;
    place = place.parent_path() / std::filesystem::read_symlink(place, error);
    if (error) return path;
  }
  return place.string();
}

// Of UTF-8.
bool IsInsideCharacter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) == 0x80; }

// Of each replacement another one. The name is cut, so that it fits where that of the file does.
std::string DraftOf(const std::string& place) {
  constexpr size_t kMostOfName = 100;
  static std::atomic<int> number = 0;
  const size_t name = place.rfind('/') + 1;
  size_t end = std::min(place.size(), name + kMostOfName);
  while (end < place.size() && IsInsideCharacter(place[end])) --end;
  return absl::StrFormat("%s.part%d.%d", place.substr(0, end), ::getpid(), number.fetch_add(1));
}

}  // namespace

FileReplacement::FileReplacement(std::string place, std::string draft, exec::Descriptor descriptor)
    : place_(std::move(place)), draft_(std::move(draft)), descriptor_(std::move(descriptor)) {}

absl::StatusOr<std::unique_ptr<FileReplacement>> FileReplacement::Begin(
    const std::string& path, const std::stop_token& stop) {
  if (IsFolder(path)) return SystemStatus(EISDIR);
  if (IsNameTooLong(path)) return SystemStatus(ENAMETOOLONG);  // the draft's is shorter
  const bool special = IsSpecialFile(path);
  const std::string place = special ? path : BehindLinks(path);
  std::string draft;
  const auto create = [&] {
    draft = DraftOf(place);
    // mkstemp() would ignore the umask.
    return ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  };
  exec::Descriptor file = special ? OpenSpecial(path, stop) : exec::Descriptor(create());
  // Processes that were killed leave drafts, in containers often of the same number.
  constexpr int kMostDrafts = 1000;
  for (int n = 1; !file.is_open() && errno == EEXIST && n < kMostDrafts; ++n) {
    file = exec::Descriptor(create());
  }
  if (!file.is_open() && special && stop.stop_requested()) return Stopped();
  if (!file.is_open()) return CreationStatus(errno, place);
  return std::unique_ptr<FileReplacement>(new FileReplacement(place, draft, std::move(file)));
}

absl::Status FileReplacement::Check(const std::string& path) {
  if (!IsSpecialFile(path)) return Begin(path).status();
  // Opening a pipe would wait for its reader.
  return ::access(path.c_str(), W_OK) == 0 ? absl::OkStatus() : SystemStatus(errno);
}

FileReplacement::~FileReplacement() {
  if (!draft_.empty()) ::unlink(draft_.c_str());
}

absl::Status FileReplacement::WriteAt(uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const bool in_order = offset == end_;  // as pipes take them
    const ssize_t count = in_order ? ::write(descriptor_.get(), bytes.data(), bytes.size())
                                   : ::pwrite(descriptor_.get(), bytes.data(), bytes.size(),
                                              static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return SystemStatus(errno);
    offset += static_cast<uint64_t>(count);
    if (in_order) end_ = offset;
    bytes = bytes.subspan(static_cast<size_t>(count));
  }
  return absl::OkStatus();
}

absl::Status FileReplacement::Commit(const std::stop_token& stop) {
  if (stop.stop_requested()) return Stopped();
  const bool synced = draft_.empty() || ::fsync(descriptor_.get()) == 0;
  // Some file systems report a full disk only here.
  if (!synced || !descriptor_.Close()) return SystemStatus(errno);
  if (stop.stop_requested()) return Stopped();
  if (draft_.empty()) return absl::OkStatus();
  if (std::rename(draft_.c_str(), place_.c_str()) != 0) return SystemStatus(errno);
  draft_.clear();
  return absl::OkStatus();
}

}  // namespace bccskel
