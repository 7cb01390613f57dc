#ifndef BCCSKEL_CORE_IMPORT_IMAGE_TIFF_CLIENT_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_TIFF_CLIENT_H_

#include <tiffio.h>

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_file.h"

namespace bccskel {

// libtiff reading from an ImageFile, with its complaints kept instead of printed.
class TiffClient {
 public:
  // The library takes at most `max_allocation_bytes` at once.
  static absl::StatusOr<std::unique_ptr<TiffClient>> Open(std::shared_ptr<const ImageFile> file,
                                                          uint64_t max_allocation_bytes);
  ~TiffClient();
  TiffClient(const TiffClient&) = delete;
  TiffClient& operator=(const TiffClient&) = delete;

  TIFF* tiff() const { return tiff_; }
  const ImageFile& file() const { return *file_; }

  // INVALID_ARGUMENT: `what`, and the library's last complaint.
  absl::Status Error(const std::string& what) const;

 private:
  explicit TiffClient(std::shared_ptr<const ImageFile> file) : file_(std::move(file)) {}

  static tmsize_t Read(thandle_t client, void* into, tmsize_t bytes);
  static tmsize_t Write(thandle_t client, void* from, tmsize_t bytes);
  static toff_t Seek(thandle_t client, toff_t offset, int whence);
  static int Close(thandle_t client);
  static toff_t Size(thandle_t client);
  static int Complain(TIFF* tiff, void* client, const char* module, const char* format,
                      va_list arguments);
  static int Ignore(TIFF* tiff, void* client, const char* module, const char* format,
                    va_list arguments);

  std::shared_ptr<const ImageFile> file_;
  uint64_t offset_ = 0;
  std::string complaint_;
  TIFF* tiff_ = nullptr;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_TIFF_CLIENT_H_
