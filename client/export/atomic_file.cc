#include "client/export/atomic_file.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/io/file_replacement.h"

namespace bccskel::exporting {
namespace {

absl::Status WriteFileUntil(const std::stop_token& stop, const std::string& path,
                            std::span<const std::byte> bytes) {
  constexpr size_t kMostAtOnce = size_t{1} << 22;  // so that a stop takes effect
  BCCSKEL_ASSIGN_OR_RETURN(const std::unique_ptr<FileReplacement> file,
                           FileReplacement::Begin(path, stop));
  for (size_t at = 0; at < bytes.size() && !stop.stop_requested(); at += kMostAtOnce) {
    const size_t count = std::min(kMostAtOnce, bytes.size() - at);
    BCCSKEL_RETURN_IF_ERROR(file->WriteAt(at, bytes.subspan(at, count)));
  }
  return file->Commit(stop);
}

absl::Status OfWriting(const std::string& path, const absl::Status& status) {
  if (status.ok()) return status;
  const char* what = absl::IsCancelled(status) ? "" : "cannot write ";
  return absl::Status(status.code(), absl::StrCat(what, path, ": ", status.message()));
}

}  // namespace

absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes,
                                 const std::stop_token& stop) {
  return OfWriting(path, WriteFileUntil(stop, path, std::as_bytes(std::span(bytes))));
}

absl::Status CheckWritable(const std::string& path) {
  return OfWriting(path, FileReplacement::Check(path));
}

}  // namespace bccskel::exporting
