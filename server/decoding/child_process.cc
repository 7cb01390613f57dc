#include "server/decoding/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/bricks_header.h"
#include "core/io/volume_decoder.h"
#include "server/decoding/decoding_child.h"

namespace bccskel::server {

// The limits of a child for one volume.
struct DecodingBudget {
  uint64_t memory_bytes = 0;               // in addition to its memory before the volume
  std::chrono::seconds processor_time{0};  // in the child
  std::chrono::seconds wall_time{0};       // until the last byte of its reply
};

namespace {

// Measured: 200 MB/s for ZIP, 500 for RLE; sanitizers and old machines take ten times as long.
constexpr uint64_t kSlowestBytesPerSecond = uint64_t{16} << 20;
// The allocator's slack, and vectors that double while they grow.
constexpr uint64_t kSlackBytes = uint64_t{64} << 20;

using Clock = exec::Context::Clock;
using KeepWaiting = ChildChannel::KeepWaiting;

// Longest message of a child; real ones are much shorter.
constexpr uint64_t kMaxWords = 1024;
constexpr uint64_t kPieceBytes = 256 * 1024;
constexpr std::chrono::seconds kTimeToStart(60);

// How a child starts: nothing open but /dev/null and the channel, detached from the terminal, and
// ignoring the signals that end the server, which ends its children itself.
class SpawnPlan {
 public:
  explicit SpawnPlan(int channel) {
    posix_spawn_file_actions_init(&files_);
    for (const int standard : {0, 1, 2}) {
      posix_spawn_file_actions_addopen(&files_, standard, "/dev/null", O_RDWR, 0);
    }
    posix_spawn_file_actions_adddup2(&files_, channel, kChildChannel);
    posix_spawn_file_actions_addclosefrom_np(&files_, kChildChannel + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t deaf;
    sigemptyset(&deaf);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&deaf, signal);
    posix_spawnattr_setsigmask(&attributes_, &deaf);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  // Returns an error number. Passes on only what the loader needs of the environment, which may
  // hold secrets.
  int Spawn(const std::vector<std::string>& command, pid_t& pid) const {
    std::vector<char*> arguments;
    for (const std::string& part : command) arguments.push_back(const_cast<char*>(part.c_str()));
    arguments.push_back(nullptr);
    const char* const path = std::getenv("LD_LIBRARY_PATH");
    std::string library_path = path == nullptr ? "" : std::string("LD_LIBRARY_PATH=") + path;
    std::array<char*, 2> environment = {path == nullptr ? nullptr : library_path.data(), nullptr};
    return posix_spawn(&pid, command[0].c_str(), &files_, &attributes_, arguments.data(),
                       environment.data());
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

// Several times the need of a well-formed volume with this header: more indicates an attack.
DecodingBudget BudgetFor(const VolumeHeader& header, uint64_t encoded_bytes) {
  const std::chrono::seconds processor(2 + header.decoded_bytes / kSlowestBytesPerSecond);
  return {.memory_bytes = kSlackBytes + 2 * header.DecodingBytes(encoded_bytes),
          .processor_time = processor,
          // The processors may be busy with other jobs.
          .wall_time = std::chrono::seconds(30) + 8 * processor};
}

absl::Status Nonsense() {
  return absl::InvalidArgumentError(
      "the volume could not be decoded: the decoder's answer is not a volume");
}

// Whether bricks with this header can be the decoded form of the announced volume.
bool Answers(const VolumeHeader& bricks, const VolumeHeader& announced, uint64_t bytes) {
  return bricks.compression == VolumeCompression::kNone && bricks.extent == announced.extent &&
         bricks.placement == announced.placement &&
         bytes == kBricksHeaderBytes + bricks.decoded_bytes;
}

KeepWaiting Until(const exec::Context& context, Clock::time_point end) {
  return [&context, end]() -> absl::Status {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    if (Clock::now() < end) return absl::OkStatus();
    return absl::UnavailableError("the child takes too long");
  };
}

// The context's own errors go to the caller unchanged.
bool IsStop(const absl::Status& status) {
  return absl::IsCancelled(status) || absl::IsDeadlineExceeded(status);
}

// A compromised child may send any bytes.
std::string Printable(std::string words) {
  std::ranges::replace_if(
      words, [](char c) { return c < ' ' || c > '~'; }, '?');
  return words;
}

// The hard limit stays: the next volume may need more.
void LimitSoftly(pid_t pid, __rlimit_resource resource, uint64_t most) {
  rlimit limit = {};
  if (prlimit(pid, resource, nullptr, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(most, limit.rlim_max);
  prlimit(pid, resource, &limit, nullptr);
}

uint64_t ProcessorSeconds(pid_t pid) {
  clockid_t clock = 0;
  timespec time = {};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return static_cast<uint64_t>(time.tv_sec);
}

std::string HowItEnded(int status, const DecodingBudget& budget) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return absl::StrFormat("it took more than %d s of processor time",
                           budget.processor_time.count());
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kChildOutOfMemory) {
    return absl::StrFormat("it needed more than %d bytes of memory", budget.memory_bytes);
  }
  if (WIFSIGNALED(status)) {
    return absl::StrFormat("the decoder ended with signal %d", WTERMSIG(status));
  }
  return absl::StrFormat("the decoder ended with code %d", WEXITSTATUS(status));
}

}  // namespace

absl::StatusOr<std::unique_ptr<ChildProcess>> ChildProcess::Start(
    const std::vector<std::string>& command) {
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return NoDecoder("no channel to a decoder", errno);
  }
  exec::Descriptor ours(ends[0]);
  const exec::Descriptor theirs(ends[1]);
  pid_t pid = 0;
  if (const int error = SpawnPlan(theirs.get()).Spawn(command, pid); error != 0) {
    return NoDecoder("no decoder can be started", error);
  }
  return std::unique_ptr<ChildProcess>(new ChildProcess(pid, std::move(ours)));
}

ChildProcess::~ChildProcess() {
  if (ended_) return;
  kill(pid_, SIGKILL);
  while (waitpid(pid_, &exit_status_, 0) < 0 && errno == EINTR) {
  }
}

bool ChildProcess::Lives() {
  if (!ended_) ended_ = waitpid(pid_, &exit_status_, WNOHANG) != 0;
  return !ended_;
}

absl::StatusOr<Volume> ChildProcess::Decode(const SharedBytes& bytes, const VolumeHeader& announced,
                                            const VolumeLimits& limits,
                                            const exec::Context& context) {
  const DecodingBudget budget = BudgetFor(announced, bytes.size());
  const Clock::time_point now = Clock::now();
  absl::Status taken = BecomeReady(Until(context, now + kTimeToStart));
  const KeepWaiting keep_waiting = Until(context, now + kTimeToStart + budget.wall_time);
  if (taken.ok()) taken = HandOver(bytes, budget, limits, keep_waiting);
  if (IsStop(taken)) return taken;
  if (!taken.ok()) return NoDecoder("a decoder was lost", ECHILD);
  DecodeReply reply;
  absl::Status received = channel_.ReceiveMessage(reply, keep_waiting);
  if (received.ok() && reply.kind == ReplyKind::kFault) return ReceiveFault(reply, keep_waiting);
  if (received.ok()) {
    absl::StatusOr<Volume> volume = ReceiveVolume(reply, announced, context, keep_waiting);
    if (!absl::IsUnavailable(volume.status())) return volume;
    received = volume.status();
  }
  return IsStop(received) ? received : Blame(budget);
}

absl::Status ChildProcess::BecomeReady(const KeepWaiting& keep_waiting) {
  if (ready_) return absl::OkStatus();
  ChildHello hello;
  BCCSKEL_RETURN_IF_ERROR(channel_.ReceiveMessage(hello, keep_waiting));
  address_space_bytes_ = hello.address_space_bytes;
  ready_ = true;
  return absl::OkStatus();
}

absl::Status ChildProcess::HandOver(const SharedBytes& bytes, const DecodingBudget& budget,
                                    const VolumeLimits& limits, const KeepWaiting& keep_waiting) {
  Restrict(budget);
  const DecodeRequest request = {.encoded_bytes = bytes.size(), .limits = limits};
  BCCSKEL_RETURN_IF_ERROR(channel_.SendRequest(request, bytes.descriptor()));
  DecodeReply reply;
  return channel_.ReceiveMessage(reply, keep_waiting);
}

// Set from outside, because the child is not trusted to do it, and again for each volume.
void ChildProcess::Restrict(const DecodingBudget& budget) const {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  LimitSoftly(pid_, RLIMIT_AS, address_space_bytes_ + budget.memory_bytes);
#endif
  const auto seconds = static_cast<uint64_t>(budget.processor_time.count());
  LimitSoftly(pid_, RLIMIT_CPU, ProcessorSeconds(pid_) + seconds);
}

// Decodes the child's answer with the server's own decoder of bricks and all its checks.
absl::StatusOr<Volume> ChildProcess::ReceiveVolume(const DecodeReply& reply,
                                                   const VolumeHeader& announced,
                                                   const exec::Context& context,
                                                   const KeepWaiting& keep_waiting) {
  VolumeLimits limits;
  limits.max_bricks = announced.max_bricks;
  std::vector<std::byte> piece(kBricksHeaderBytes);
  if (reply.kind != ReplyKind::kVolume || reply.bytes < piece.size()) return Nonsense();
  BCCSKEL_RETURN_IF_ERROR(channel_.Receive(piece, keep_waiting));
  const auto header = ScanVolumeHeader(VolumeEncoding::kBricks, piece, limits);
  if (!header.ok() || !Answers(*header, announced, reply.bytes)) return Nonsense();
  const auto decoder = MakeVolumeDecoder(*header, limits);
  if (!decoder.ok()) return Nonsense();
  for (uint64_t left = reply.bytes;;) {
    if (!(*decoder)->Append(piece).ok()) return Nonsense();
    left -= piece.size();
    if (left == 0) break;
    piece.resize(std::min(left, kPieceBytes));
    BCCSKEL_RETURN_IF_ERROR(channel_.Receive(piece, keep_waiting));
  }
  absl::StatusOr<Volume> volume = (*decoder)->Finish(context);
  return volume.ok() || IsStop(volume.status()) ? std::move(volume) : Nonsense();
}

absl::Status ChildProcess::ReceiveFault(const DecodeReply& reply, const KeepWaiting& keep_waiting) {
  std::string words(std::min(reply.bytes, kMaxWords), ' ');
  absl::Status received = channel_.Receive(std::as_writable_bytes(std::span(words)), keep_waiting);
  if (IsStop(received)) return received;
  const auto code = static_cast<absl::StatusCode>(reply.status_code);
  const bool over_limit = code == absl::StatusCode::kResourceExhausted;
  return absl::Status(over_limit ? code : absl::StatusCode::kInvalidArgument, Printable(words));
}

// A child that is still alive has sent nonsense or hangs, which is no better than a crash.
absl::Status ChildProcess::Blame(const DecodingBudget& budget) {
  kill(pid_, SIGKILL);
  while (!ended_) {
    ended_ = waitpid(pid_, &exit_status_, 0) == pid_ || errno != EINTR;
  }
  return absl::InvalidArgumentError("the volume could not be decoded: " +
                                    HowItEnded(exit_status_, budget));
}

}  // namespace bccskel::server
