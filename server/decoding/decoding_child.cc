#include "server/decoding/decoding_child.h"

#include <malloc.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "server/decoding/child_channel.h"
#include "server/decoding/child_sandbox.h"
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {
namespace {

uint64_t AddressSpaceBytes() {
  unsigned long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
  std::fclose(file);
  return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

// Large blocks go back to the system with their volume: between volumes a child holds next to
// nothing, and nobody has admitted it.
void ConfigureAllocator() {
  constexpr int kLargeBlock = 256 * 1024;
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  mallopt(M_TRIM_THRESHOLD, kLargeBlock);
}

// The bricks encoding, which the server's own decoder takes with all its checks.
absl::StatusOr<std::string> Decode(const DecodeRequest& request, const Descriptor& file) {
  BCCSKEL_ASSIGN_OR_RETURN(const MappedBytes mapped,
                           MappedBytes::Map(file.get(), request.encoded_bytes));
  BCCSKEL_ASSIGN_OR_RETURN(const Volume volume,
                           DecodeVolume(VolumeEncoding::kOpenExr, mapped.bytes(), request.limits));
  return EncodeVolume(
      volume, {.encoding = VolumeEncoding::kBricks, .compression = VolumeCompression::kNone});
}

absl::Status Reply(ChildChannel& channel, ReplyKind kind, absl::StatusCode code,
                   const std::string& bytes) {
  BCCSKEL_RETURN_IF_ERROR(channel.SendMessage(
      DecodeReply{.kind = kind, .status_code = static_cast<int32_t>(code), .bytes = bytes.size()}));
  return channel.Send(std::as_bytes(std::span(bytes)));
}

absl::Status ServeOne(ChildChannel& channel) {
  DecodeRequest request;
  Descriptor file;
  BCCSKEL_RETURN_IF_ERROR(channel.ReceiveRequest(request, file));
  BCCSKEL_RETURN_IF_ERROR(channel.SendMessage(DecodeReply()));
  const absl::StatusOr<std::string> volume = Decode(request, file);
  if (volume.ok()) return Reply(channel, ReplyKind::kVolume, absl::StatusCode::kOk, *volume);
  return Reply(channel, ReplyKind::kFault, volume.status().code(),
               std::string(volume.status().message()));
}

int Serve() {
  ConfigureAllocator();
  const uint64_t address_space_bytes = AddressSpaceBytes();
  EnterChildSandbox();
  ChildChannel channel{Descriptor(kChildChannel)};
  absl::Status status = channel.SendMessage(ChildHello{address_space_bytes});
  try {
    while (status.ok()) status = ServeOne(channel);
  } catch (const std::bad_alloc&) {
    _exit(kChildOutOfMemory);
  }
  _exit(0);  // the destructors of a whole server have nothing to do here
}

}  // namespace

std::vector<std::string> ThisProgramAsChild() { return {"/proc/self/exe", kChildArgument}; }

std::optional<int> RunIfDecodingChild(int argc, const char* const* argv) {
  if (argc != 2 || std::strcmp(argv[1], kChildArgument) != 0) return std::nullopt;
  return Serve();
}

}  // namespace bccskel::server
