#include "core/import/image/tiff_client.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <span>
#include <utility>

namespace bccskel {

absl::StatusOr<std::unique_ptr<TiffClient>> TiffClient::Open(std::shared_ptr<const ImageFile> file,
                                                             uint64_t max_allocation_bytes) {
  std::unique_ptr<TiffClient> client(new TiffClient(std::move(file)));
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (options == nullptr) return absl::ResourceExhaustedError("not enough memory for libtiff");
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(max_allocation_bytes));
  TIFFOpenOptionsSetErrorHandlerExtR(options, &Complain, client.get());
  TIFFOpenOptionsSetWarningHandlerExtR(options, &Ignore, client.get());
  // 'm': no mapping into memory, where a file that shrinks would be fatal.
  client->tiff_ = TIFFClientOpenExt("image", "rm", client.get(), &Read, &Write, &Seek, &Close,
                                    &Size, nullptr, nullptr, options);
  TIFFOpenOptionsFree(options);
  if (client->tiff_ == nullptr) return client->Error("not a TIFF file that can be read");
  return client;
}

TiffClient::~TiffClient() {
  if (tiff_ != nullptr) TIFFClose(tiff_);
}

absl::Status TiffClient::Error(const std::string& what) const {
  return absl::InvalidArgumentError(complaint_.empty() ? what : what + ": " + complaint_);
}

tmsize_t TiffClient::Read(thandle_t client, void* into, tmsize_t bytes) {
  auto& self = *static_cast<TiffClient*>(client);
  if (bytes < 0) return -1;
  const absl::StatusOr<size_t> got = self.file_->ReadAt(
      self.offset_, std::span(static_cast<std::byte*>(into), static_cast<size_t>(bytes)));
  if (!got.ok()) return -1;
  self.offset_ += *got;
  return static_cast<tmsize_t>(*got);
}

tmsize_t TiffClient::Write(thandle_t, void*, tmsize_t) { return -1; }

toff_t TiffClient::Seek(thandle_t client, toff_t offset, int whence) {
  auto& self = *static_cast<TiffClient*>(client);
  if (whence == SEEK_CUR) offset += self.offset_;
  if (whence == SEEK_END) offset += self.file_->size();
  return self.offset_ = offset;
}

int TiffClient::Close(thandle_t) { return 0; }

toff_t TiffClient::Size(thandle_t client) {
  return static_cast<TiffClient*>(client)->file_->size();
}

int TiffClient::Complain(TIFF*, void* client, const char*, const char* format, va_list arguments) {
  std::array<char, 256> text = {};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  // From here libtiff's own C code goes on: nothing may be thrown through it.
  try {
    static_cast<TiffClient*>(client)->complaint_ = text.data();
  } catch (const std::bad_alloc&) {
  }
  return 1;
}

int TiffClient::Ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace bccskel
