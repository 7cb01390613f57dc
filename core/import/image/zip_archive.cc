#include "core/import/image/zip_archive.h"

#include <zip.h>

#include <algorithm>
#include <span>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

absl::Status ZipError(const char* what, zip_error_t* error) {
  return absl::InvalidArgumentError(absl::StrFormat("%s: %s", what, zip_error_strerror(error)));
}

// libzip reading from an ImageFile.
class ZipArchive {
 public:
  static absl::StatusOr<std::unique_ptr<ZipArchive>> Open(std::shared_ptr<const ImageFile> file) {
    std::unique_ptr<ZipArchive> archive(new ZipArchive(std::move(file)));
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_function_create(&Serve, archive.get(), &error);
    if (source != nullptr) archive->zip_ = zip_open_from_source(source, ZIP_RDONLY, &error);
    if (archive->zip_ == nullptr && source != nullptr) zip_source_free(source);
    const absl::Status status = ZipError("the zip archive is cut or damaged", &error);
    zip_error_fini(&error);
    if (archive->zip_ == nullptr) return status;
    return archive;
  }
  ~ZipArchive() {
    if (zip_ != nullptr) zip_discard(zip_);
    zip_error_fini(&error_);
  }
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  zip_t* zip() const { return zip_; }

 private:
  explicit ZipArchive(std::shared_ptr<const ImageFile> file) : file_(std::move(file)) {
    zip_error_init(&error_);
  }

  static zip_int64_t Serve(void* archive, void* data, zip_uint64_t bytes,
                           zip_source_cmd_t command) {
    return static_cast<ZipArchive*>(archive)->Answer(data, bytes, command);
  }

  zip_int64_t Answer(void* data, zip_uint64_t bytes, zip_source_cmd_t command) {
    switch (command) {
      case ZIP_SOURCE_OPEN:
        offset_ = 0;
        return 0;
      case ZIP_SOURCE_READ:
        return Read({static_cast<std::byte*>(data), static_cast<size_t>(bytes)});
      case ZIP_SOURCE_SEEK: {
        const zip_int64_t next =
            zip_source_seek_compute_offset(offset_, file_->size(), data, bytes, &error_);
        if (next >= 0) offset_ = static_cast<uint64_t>(next);
        return next < 0 ? -1 : 0;
      }
      case ZIP_SOURCE_TELL:
        return static_cast<zip_int64_t>(offset_);
      case ZIP_SOURCE_STAT: {
        auto* const stat = static_cast<zip_stat_t*>(data);
        zip_stat_init(stat);
        stat->valid = ZIP_STAT_SIZE;
        stat->size = file_->size();
        return sizeof(zip_stat_t);
      }
      case ZIP_SOURCE_ERROR:
        return zip_error_to_data(&error_, data, bytes);
      case ZIP_SOURCE_SUPPORTS:
        return zip_source_make_command_bitmap(
            ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE, ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR,
            ZIP_SOURCE_FREE, ZIP_SOURCE_SEEK, ZIP_SOURCE_TELL, ZIP_SOURCE_SUPPORTS, -1);
      default:  // to close and to free: both are ours
        return 0;
    }
  }

  zip_int64_t Read(std::span<std::byte> into) {
    const absl::StatusOr<size_t> got = file_->ReadAt(offset_, into);
    if (!got.ok()) {
      zip_error_set(&error_, ZIP_ER_READ, 0);
      return -1;
    }
    offset_ += *got;
    return static_cast<zip_int64_t>(*got);
  }

  std::shared_ptr<const ImageFile> file_;
  uint64_t offset_ = 0;
  zip_error_t error_ = {};
  zip_t* zip_ = nullptr;
};

class ZipStream : public ByteStream {
 public:
  ZipStream(std::unique_ptr<ZipArchive> archive, zip_file_t* member)
      : archive_(std::move(archive)), member_(member) {}
  ~ZipStream() override { zip_fclose(member_); }

  absl::StatusOr<size_t> Read(std::span<std::byte> into) override {
    size_t filled = 0;
    while (filled < into.size()) {
      const zip_int64_t got = zip_fread(member_, into.data() + filled, into.size() - filled);
      if (got < 0) return ZipError("the array is cut or damaged", zip_file_get_error(member_));
      if (got == 0) break;
      filled += static_cast<size_t>(got);
    }
    return filled;
  }

 private:
  std::unique_ptr<ZipArchive> archive_;
  zip_file_t* member_;
};

}  // namespace

bool IsZip(std::string_view front) {
  return front.starts_with("PK\3\4") || front.starts_with("PK\5\6");  // that of an empty one
}

absl::StatusOr<std::vector<std::string>> ZipNames(std::shared_ptr<const ImageFile> file) {
  BCCSKEL_ASSIGN_OR_RETURN(const auto archive, ZipArchive::Open(std::move(file)));
  const zip_int64_t count = zip_get_num_entries(archive->zip(), 0);
  std::vector<std::string> names;
  for (zip_int64_t n = 0; n < count; ++n) {
    const char* const name = zip_get_name(archive->zip(), static_cast<zip_uint64_t>(n), 0);
    names.emplace_back(name == nullptr ? "" : name);
  }
  return names;
}

absl::StatusOr<std::unique_ptr<ByteStream>> OpenZipMember(std::shared_ptr<const ImageFile> file,
                                                          uint64_t number) {
  BCCSKEL_ASSIGN_OR_RETURN(auto archive, ZipArchive::Open(std::move(file)));
  zip_file_t* const member = zip_fopen_index(archive->zip(), number, 0);
  if (member == nullptr) {
    return ZipError("the array cannot be read", zip_get_error(archive->zip()));
  }
  return std::make_unique<ZipStream>(std::move(archive), member);
}

}  // namespace bccskel
