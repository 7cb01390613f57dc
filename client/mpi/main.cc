#include <fcntl.h>
#include <malloc.h>
#include <mpi.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "client/cli/arguments.h"
#include "client/cli/console.h"
#include "client/mpi/mpi_exchange.h"
#include "client/mpi/rank_command.h"
#include "client/mpi/rank_options.h"
#include "core/version/version.h"

namespace {

using bccskel::cli::ExitCode;
using bccskel::cli::MpiExchange;

// All ranks read the same command line; only rank 0 reports its errors.
class Silence {
 public:
  explicit Silence(bool wanted) {
    if (!wanted) return;
    std::fflush(nullptr);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (size_t n = 0; n < 2; ++n) {
      const int stream = static_cast<int>(n) + 1;
      kept_[n] = fcntl(stream, F_DUPFD_CLOEXEC, 3);
      dup2(nowhere, stream);
    }
    close(nowhere);
  }
  ~Silence() {
    std::fflush(nullptr);
    for (size_t n = 0; n < 2; ++n) {
      if (kept_[n] < 0) continue;
      dup2(kept_[n], static_cast<int>(n) + 1);
      close(kept_[n]);
    }
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_[2] = {-1, -1};
};

struct Command {
  bccskel::cli::SkeletonizeArguments arguments;
  bccskel::cli::RankOptions options;
};

std::variant<Command, ExitCode> Parse(std::vector<std::string> words) {
  const std::string first = words.empty() ? "" : words.front();
  if (first == "--version") {
    return bccskel::cli::Print("bccskel-mpi " + std::string(bccskel::Version()) + "\n");
  }
  if (first == "--help" || first == "-h") words.insert(words.begin(), "skeletonize");
  if (first.empty()) {
    return bccskel::cli::FailWith(
        ExitCode::kUsage, absl::InvalidArgumentError(
                              "the command is missing: bccskel-mpi skeletonize INPUT -o OUTPUT"));
  }
  const auto options = bccskel::cli::TakeRankOptions(words);
  if (!options.ok()) return bccskel::cli::FailWith(ExitCode::kUsage, options.status());
  std::vector<const char*> pointers = {"bccskel-mpi"};
  for (const std::string& word : words) pointers.push_back(word.c_str());
  auto parsed = bccskel::cli::ParseArguments(static_cast<int>(pointers.size()), pointers.data());
  if (const auto* code = std::get_if<ExitCode>(&parsed)) {
    const bool help = std::ranges::any_of(
        words, [](std::string_view word) { return word == "--help" || word == "-h"; });
    if (help) return bccskel::cli::Print(bccskel::cli::kRankOptionsHelp);
    return *code;
  }
  auto arguments =
      bccskel::cli::RankArguments(std::get<bccskel::cli::Arguments>(std::move(parsed)));
  if (!arguments.ok()) return bccskel::cli::FailWith(ExitCode::kUsage, arguments.status());
  return Command{*std::move(arguments), *options};
}

// One line per stage, which scripts read, and one for the rank.
void Report(MpiExchange& exchange) {
  exchange.Enter(bccskel::ranks::Stage::kGathering);  // this also ends the stage
  constexpr const char* kStages[bccskel::ranks::kStageCount] = {"sharing", "distances", "thinning",
                                                                "topology", "gathering"};
  for (size_t n = 0; n < bccskel::ranks::kStageCount; ++n) {
    const bccskel::cli::ExchangeCounts& counts =
        exchange.counts(static_cast<bccskel::ranks::Stage>(n));
    std::fprintf(stderr,
                 "bccskel-mpi: rank %d of %d: %s: %llu trades, %llu sums, %llu messages, %llu "
                 "bytes sent, %.3f s in them, %lld MiB so far\n",
                 exchange.rank(), exchange.size(), kStages[n],
                 static_cast<unsigned long long>(counts.trades),
                 static_cast<unsigned long long>(counts.sums),
                 static_cast<unsigned long long>(counts.messages),
                 static_cast<unsigned long long>(counts.bytes), counts.waited,
                 static_cast<long long>(counts.peak / 1024));
  }
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  const double seconds = static_cast<double>(usage.ru_utime.tv_sec) +
                         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
  std::fprintf(stderr, "bccskel-mpi: rank %d of %d: %.2f s of processor time, %ld MiB at most\n",
               exchange.rank(), exchange.size(), seconds, usage.ru_maxrss / 1024);
}

// A rank that fails ends the others, which would wait forever.
ExitCode RunOrAbort(const Command& command, MpiExchange& exchange, const std::stop_token& stop) {
  try {
    return bccskel::cli::RunRank(command.arguments, command.options, exchange, stop);
  } catch (const std::exception& error) {
    std::fprintf(stderr,
                 "bccskel-mpi: error: rank %d of %d: out of memory or another failure of the "
                 "system: %s; the job ends. Take more ranks or machines with more memory.\n",
                 exchange.rank(), exchange.size(), error.what());
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ExitCode::kTooLarge));
    return ExitCode::kTooLarge;
  }
}

ExitCode Main(const std::vector<std::string>& words) {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);  // as in client/cli/main.cc
  // Arrays of megabytes go back to the system after use; smaller ones, such as messages to many
  // ranks, are needed again in the next round.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 8 << 20);
  const bccskel::cli::Interrupt interrupt;  // before MPI's threads
  std::signal(SIGPIPE, SIG_IGN);
  bccskel::cli::SetProgramName("bccskel-mpi");
  int level = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
  ExitCode code = ExitCode::kOk;
  {
    MpiExchange exchange(MPI_COMM_WORLD);
    const auto parsed = [&] {
      const Silence silence(exchange.rank() != 0);
      return Parse(words);
    }();
    if (const auto* end = std::get_if<ExitCode>(&parsed)) {
      code = *end;
    } else {
      const Command& command = std::get<Command>(parsed);
      code = RunOrAbort(command, exchange, interrupt.token());
      if (command.options.report == bccskel::cli::ExchangeReport::kYes) Report(exchange);
    }
  }
  MPI_Finalize();
  return code == ExitCode::kOk ? code : interrupt.exit_code().value_or(code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return static_cast<int>(Main({argv + std::min(argc, 1), argv + argc}));
  } catch (const std::exception& error) {  // mpirun then ends the other ranks
    std::fprintf(stderr, "bccskel-mpi: error: %s\n", error.what());
    return static_cast<int>(ExitCode::kTooLarge);
  }
}
