#ifndef BCCSKEL_CLIENT_MPI_FILE_FOLDER_H_
#define BCCSKEL_CLIENT_MPI_FILE_FOLDER_H_

#include <string>

#include "core/ranks/checkpoints.h"

namespace bccskel::cli {

// A folder of the file system, which must be the same for all ranks.
class FileFolder : public ranks::CheckpointFolder {
 public:
  explicit FileFolder(std::string path) : path_(std::move(path)) {}

  // Creates the folder if missing. Errors name the path.
  absl::Status Make() const;

  absl::Status Write(const std::string& name, const ranks::Bytes& bytes) override;
  absl::StatusOr<ranks::Bytes> Read(const std::string& name) override;
  void Remove(const std::string& name) override;

 private:
  std::string PathOf(const std::string& name) const { return path_ + "/" + name; }

  const std::string path_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_MPI_FILE_FOLDER_H_
