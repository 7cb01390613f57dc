#include "server/store/disk_reserve.h"

#include <fcntl.h>

#include "server/store/file_io.h"

namespace bccskel::server {
namespace {

// Several hundred changes of the tables, and what SQLite needs to tidy up after them.
constexpr off_t kBytes = off_t{1} << 20;

}  // namespace

void DiskReserve::Hold() {
  if (held_) return;
  const auto file = File::OpenToWrite(path_);
  held_ = file.ok() && posix_fallocate(file->fd(), 0, kBytes) == 0;
  if (!held_) Release();
}

void DiskReserve::Release() {
  held_ = false;
  RemoveFile(path_).IgnoreError();
}

}  // namespace bccskel::server
