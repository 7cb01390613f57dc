#include "server/decoding/decoding_child.h"

#include <malloc.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
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
#include "server/decoding/shared_bytes.h"

namespace bccskel::server {
namespace {

// Sanitizers need system calls and address space of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

void Limit(__rlimit_resource resource, rlim_t most) {
  const rlimit limit = {most, most};
  setrlimit(resource, &limit);
}

// Memory, the channel and exit. None of them opens, connects, forks, signals or changes a limit.
constexpr int kSystemCalls[] = {
    SCMP_SYS(read),   SCMP_SYS(write),      SCMP_SYS(recvfrom),     SCMP_SYS(sendto),
    SCMP_SYS(poll),   SCMP_SYS(recvmsg),    SCMP_SYS(close),        SCMP_SYS(munmap),
    SCMP_SYS(mremap), SCMP_SYS(madvise),    SCMP_SYS(brk),          SCMP_SYS(futex),
    SCMP_SYS(exit),   SCMP_SYS(exit_group), SCMP_SYS(rt_sigreturn), SCMP_SYS(restart_syscall),
};

void LoadFilter() {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_KILL_PROCESS);
  if (filter == nullptr) return;
  for (const int call : kSystemCalls) seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
  seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(mmap), 1,
                   SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  seccomp_load(filter);
  seccomp_release(filter);
}

uint64_t AddressSpaceBytes() {
  unsigned long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
  std::fclose(file);
  return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

// Returns large blocks to the system with their volume: an idle child holds almost no memory,
// because none is reserved for it.
void ConfigureAllocator() {
  constexpr int kLargeBlock = 256 * 1024;
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  mallopt(M_TRIM_THRESHOLD, kLargeBlock);
}

// Yields the bricks encoding, which the server decodes with all its checks.
absl::StatusOr<std::string> Decode(const DecodeRequest& request, const exec::Descriptor& file) {
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
  exec::Descriptor file;
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
  ChildChannel channel{exec::Descriptor(kChildChannel)};
  absl::Status status = channel.SendMessage(ChildHello{address_space_bytes});
  try {
    while (status.ok()) status = ServeOne(channel);
  } catch (const std::bad_alloc&) {
    _exit(kChildOutOfMemory);
  }
  _exit(0);  // skips the destructors of the server's globals
}

}  // namespace

void EnterChildSandbox() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_DUMPABLE, 0);
  constexpr rlim_t kDescriptors = 8;  // three to /dev/null, the channel, a volume
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_FSIZE, 0);
  Limit(RLIMIT_NOFILE, kDescriptors);
  if (!kSanitized) LoadFilter();
}

std::vector<std::string> ThisProgramAsChild() { return {"/proc/self/exe", kChildArgument}; }

std::optional<int> RunIfDecodingChild(int argc, const char* const* argv) {
  if (argc != 2 || std::strcmp(argv[1], kChildArgument) != 0) return std::nullopt;
  return Serve();
}

}  // namespace bccskel::server
