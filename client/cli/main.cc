#include <malloc.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <variant>

#include "absl/synchronization/mutex.h"
#include "client/cli/arguments.h"
#include "client/cli/console.h"
#include "core/exec/huge_pages.h"

namespace {

using bccskel::cli::Arguments;
using bccskel::cli::ExitCode;

// Libraries throw when memory runs out, the only exception that our code can meet.
ExitCode RunCommand(const Arguments& arguments, const std::stop_token& stop) {
  const absl::Status readable = bccskel::cli::CheckServerFiles(arguments);
  if (!readable.ok()) return bccskel::cli::Fail(readable);
  const absl::Status writable = bccskel::cli::CheckOutputs(arguments);
  if (!writable.ok()) return bccskel::cli::FailWith(ExitCode::kOutput, writable);
  try {
    return std::visit([&](const auto& chosen) { return bccskel::cli::Run(chosen, stop); },
                      arguments);
  } catch (const std::bad_alloc&) {
    return bccskel::cli::Fail(
        absl::ResourceExhaustedError("not enough memory"),
        "a mesh needs less with smaller --points or a larger --spacing, an image with fewer voxels "
        "(crop it, or read a coarser --level)");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bccskel: error: system error: %s\n", error.what());
    return ExitCode::kTooLarge;
  }
}

// Debian's build of Abseil looks for deadlocks at every lock.
void DisableDeadlockDetection() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
}

// Keeps memory that one stage frees for the next. By default the allocator returns large blocks to
// the system, which clears their pages again.
void KeepFreeMemory() {
  constexpr int kMostInHeap = 32 << 20;  // the largest that it takes
  mallopt(M_MMAP_THRESHOLD, kMostInHeap);
  mallopt(M_TRIM_THRESHOLD, 2 * kMostInHeap);
}

// Because a run on a mask mostly touches small blocks and tables, page after page.
void PutHeapOnHugePages() {
  constexpr int kRoom = 48 << 20;
  mallopt(M_TOP_PAD, kRoom);
  void* volatile block = std::malloc(size_t{1} << 20);  // with the padding
  std::free(block);
  const auto* const end = static_cast<char*>(sbrk(0));
  bccskel::exec::PreferHugePages(const_cast<char*>(end) - kRoom, kRoom);
}

// gRPC logs each attempt to connect; our message says how the last one ended. By the environment,
// because a call would load gRPC's library.
void SilenceGrpc() { setenv("GRPC_VERBOSITY", "NONE", /*replace=*/0); }

ExitCode Main(int argc, char** argv) {
  DisableDeadlockDetection();
  SilenceGrpc();
  KeepFreeMemory();
  const auto parsed = bccskel::cli::ParseArguments(argc, argv);
  if (const auto* code = std::get_if<ExitCode>(&parsed)) return *code;
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe becomes an error of Print()
  PutHeapOnHugePages();
  const bccskel::cli::Interrupt interrupt;
  const ExitCode code = RunCommand(std::get<Arguments>(parsed), interrupt.token());
  return code == ExitCode::kOk ? code : interrupt.exit_code().value_or(code);
}

}  // namespace

int main(int argc, char** argv) { return static_cast<int>(Main(argc, argv)); }
