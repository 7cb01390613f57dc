#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_FILE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_FILE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "core/exec/descriptor.h"

namespace bccskel {

// Bytes that can be read at any place: those of a file, or some in memory.
class ImageFile {
 public:
  // Errors: NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT if it is not a regular file.
  static absl::StatusOr<std::shared_ptr<const ImageFile>> Open(const std::string& path);
  // `name` is used for its ending and in messages.
  static std::shared_ptr<const ImageFile> OfBytes(std::string name, std::string bytes);

  // Opens the file in the same folder that a header names as the place of its voxels. A header
  // cannot name a file in another folder, or its author could choose which files are read.
  // Errors: as Open(); INVALID_ARGUMENT for a name with a folder, and for bytes in memory.
  absl::StatusOr<std::shared_ptr<const ImageFile>> OpenBeside(const std::string& name) const;

  const std::string& name() const { return name_; }
  uint64_t size() const { return size_; }

  // How many bytes were read: fewer than asked for only at the end.
  absl::StatusOr<size_t> ReadAt(uint64_t offset, std::span<std::byte> into) const;

 private:
  ImageFile(std::string name, exec::Descriptor descriptor, uint64_t size, std::string bytes)
      : name_(std::move(name)),
        descriptor_(std::move(descriptor)),
        size_(size),
        bytes_(std::move(bytes)) {}

  std::string name_;
  exec::Descriptor descriptor_;  // not open: the bytes are in memory
  uint64_t size_;
  std::string bytes_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_FILE_H_
