#ifndef BCCSKEL_CORE_IO_FILE_REPLACEMENT_H_
#define BCCSKEL_CORE_IO_FILE_REPLACEMENT_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/descriptor.h"
#include "core/io/byte_sink.h"

namespace bccskel {

// The next content of a file, written beside it: readers of the path see the old bytes or all of
// the new ones. A link stays, and what it points to is replaced or made. What is not a regular
// file, such as /dev/null or a pipe, is written to directly; pipes take bytes in order only.
// Errors: what the system says, in words that do not name the path.
class FileReplacement final : public ByteSink {
 public:
  // Waits for the reader of a pipe. Errors: also CANCELLED after a stop request.
  static absl::StatusOr<std::unique_ptr<FileReplacement>> Begin(const std::string& path,
                                                                const std::stop_token& stop = {});
  // Whether Begin() can succeed; leaves no trace.
  static absl::Status Check(const std::string& path);

  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  ~FileReplacement() override;  // without Commit() the old file is still there

  absl::Status WriteAt(uint64_t offset, std::span<const std::byte> bytes) override;
  // Call it once. Errors: also CANCELLED after a stop request.
  absl::Status Commit(const std::stop_token& stop = {});

 private:
  FileReplacement(std::string place, std::string draft, exec::Descriptor descriptor);

  const std::string place_;
  std::string draft_;  // empty: none
  exec::Descriptor descriptor_;
  uint64_t end_ = 0;  // of what was written in order
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_FILE_REPLACEMENT_H_
