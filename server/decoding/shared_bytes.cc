#include "server/decoding/shared_bytes.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "server/errors/call_error.h"

namespace bccskel::server {

absl::Status NoDecoder(const std::string& what, int error) {
  return CallError(Reason::kDecoderBusy, what + ": " + std::generic_category().message(error));
}

absl::StatusOr<SharedBytes> SharedBytes::Create() {
  exec::Descriptor file(memfd_create("volume", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file.is_open()) return NoDecoder("no memory file for a volume", errno);
  return SharedBytes(std::move(file));
}

absl::Status SharedBytes::Append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return NoDecoder("no memory for a volume", errno);
    size_ += static_cast<uint64_t>(written);
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status SharedBytes::Seal() {
  constexpr int kSeals = F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL;
  if (fcntl(file_.get(), F_ADD_SEALS, kSeals) == 0) return absl::OkStatus();
  return NoDecoder("a volume's memory file cannot be sealed", errno);
}

absl::StatusOr<MappedBytes> MappedBytes::Map(int descriptor, uint64_t size) {
  if (size == 0) return MappedBytes({});
  void* const at = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (at == MAP_FAILED) return absl::InternalError("a volume's memory file cannot be mapped");
  return MappedBytes({static_cast<const std::byte*>(at), size});
}

MappedBytes::~MappedBytes() {
  if (bytes_.empty()) return;
  munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace bccskel::server
