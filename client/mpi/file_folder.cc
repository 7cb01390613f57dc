#include "client/mpi/file_folder.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "client/export/atomic_file.h"

namespace bccskel::cli {

absl::Status FileFolder::Make() const {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (!error) return absl::OkStatus();
  return absl::ErrnoToStatus(error.value(), "cannot create the folder " + path_);
}

absl::Status FileFolder::Write(const std::string& name, const ranks::Bytes& bytes) {
  return exporting::WriteFileAtomically(
      PathOf(name), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

absl::StatusOr<ranks::Bytes> FileFolder::Read(const std::string& name) {
  const std::string path = PathOf(name);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return absl::ErrnoToStatus(error.value(), "cannot read " + path);
  std::ifstream file(path, std::ios::binary);
  ranks::Bytes bytes(size);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
    return absl::DataLossError("cannot read " + path);
  }
  return bytes;
}

void FileFolder::Remove(const std::string& name) {
  std::error_code ignored;
  std::filesystem::remove(PathOf(name), ignored);
}

}  // namespace bccskel::cli
