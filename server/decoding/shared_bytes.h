#ifndef BCCSKEL_SERVER_DECODING_SHARED_BYTES_H_
#define BCCSKEL_SERVER_DECODING_SHARED_BYTES_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/descriptor.h"

namespace bccskel::server {

// The error for a resource that the server lacks for decoding: a CallError that tells the caller to
// retry.
absl::Status NoDecoder(const std::string& what, int error);

// An upload's bytes in memory that a child can map without a copy.
class SharedBytes {
 public:
  // Errors: a CallError when no descriptor is left.
  static absl::StatusOr<SharedBytes> Create();

  // Errors: a CallError when no memory is left.
  absl::Status Append(std::span<const std::byte> bytes);
  // From now on nobody can change the bytes, not even the server.
  absl::Status Seal();

  uint64_t size() const { return size_; }
  int descriptor() const { return file_.get(); }

 private:
  explicit SharedBytes(exec::Descriptor file) : file_(std::move(file)) {}

  exec::Descriptor file_;
  uint64_t size_ = 0;
};

// Sealed bytes as mapped by a child. The destructor unmaps them.
class MappedBytes {
 public:
  // Errors: INTERNAL.
  static absl::StatusOr<MappedBytes> Map(int descriptor, uint64_t size);
  ~MappedBytes();
  MappedBytes(MappedBytes&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  MappedBytes& operator=(MappedBytes&&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  explicit MappedBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::span<const std::byte> bytes_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_SHARED_BYTES_H_
