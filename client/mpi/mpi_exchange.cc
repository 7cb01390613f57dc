#include "client/mpi/mpi_exchange.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace bccskel::cli {
namespace {

using ranks::Bytes;

constexpr int kTag = 19;
// MPI counts in int. A message is sent in pieces of this size and a shorter last one, so that the
// receiver need not know its length in advance.
constexpr size_t kPieceBytes = size_t{1} << 30;

// Between two polls for messages.
class PollBackoff {
 public:
  void Yield() {
    constexpr auto kSpinTime = std::chrono::microseconds(100);
    constexpr auto kSleepTime = std::chrono::microseconds(50);
    if (std::chrono::steady_clock::now() - start_ < kSpinTime) {
      std::this_thread::yield();
    } else {
      std::this_thread::sleep_for(kSleepTime);
    }
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Adds its lifetime.
class WaitClock {
 public:
  explicit WaitClock(double& seconds) : seconds_(seconds) {}
  ~WaitClock() {
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
    seconds_ += time.count();
  }
  WaitClock(const WaitClock&) = delete;
  WaitClock& operator=(const WaitClock&) = delete;

 private:
  double& seconds_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Receives a piece of the message if one has arrived. Returns whether it was the last.
bool TakePiece(int peer, MPI_Comm communicator, Bytes& bytes) {
  int has_come = 0;
  MPI_Message message;
  MPI_Status status;
  MPI_Improbe(peer, kTag, communicator, &has_come, &message, &status);
  if (has_come == 0) return false;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  const size_t at = bytes.size();
  bytes.resize(at + static_cast<size_t>(count));
  MPI_Mrecv(bytes.data() + at, count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
  return static_cast<size_t>(count) < kPieceBytes;
}

}  // namespace

MpiExchange::MpiExchange(MPI_Comm communicator) {
  MPI_Comm_dup(communicator, &communicator_);
  MPI_Comm_rank(communicator_, &rank_);
  MPI_Comm_size(communicator_, &size_);
}

MpiExchange::~MpiExchange() { MPI_Comm_free(&communicator_); }

void MpiExchange::Enter(ranks::Stage stage) {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  now().peak = usage.ru_maxrss;
  stage_ = stage;
}

void MpiExchange::Send(int peer, const Bytes& bytes, std::vector<MPI_Request>& requests) {
  size_t at = 0, piece = 0;
  do {
    piece = std::min(bytes.size() - at, kPieceBytes);
    MPI_Isend(bytes.data() + at, static_cast<int>(piece), MPI_BYTE, peer, kTag, communicator_,
              &requests.emplace_back());
    at += piece;
  } while (piece == kPieceBytes);
  ++now().messages;
  now().bytes += bytes.size();
}

void MpiExchange::Trade(std::span<const int> peers, std::span<const Bytes> out,
                        std::span<Bytes> in) {
  const WaitClock waiting(now().waited);
  ++now().trades;
  std::vector<MPI_Request> sent;
  for (size_t n = 0; n < peers.size(); ++n) Send(peers[n], out[n], sent);
  for (Bytes& bytes : in) bytes.clear();
  std::vector<size_t> awaited(peers.size());
  for (size_t n = 0; n < awaited.size(); ++n) awaited[n] = n;
  int all_sent = 0;
  for (PollBackoff backoff; !awaited.empty() || all_sent == 0; backoff.Yield()) {
    std::erase_if(awaited, [&](size_t n) { return TakePiece(peers[n], communicator_, in[n]); });
    MPI_Testall(static_cast<int>(sent.size()), sent.data(), &all_sent, MPI_STATUSES_IGNORE);
    if (awaited.empty() && all_sent != 0) return;
  }
}

void MpiExchange::Reduce(std::span<uint64_t> numbers, MPI_Op operation) {
  const WaitClock waiting(now().waited);
  ++now().sums;
  MPI_Request request;
  MPI_Iallreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T,
                 operation, communicator_, &request);
  int done = 0;
  PollBackoff backoff;
  for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); done == 0;
       MPI_Test(&request, &done, MPI_STATUS_IGNORE)) {
    backoff.Yield();
  }
}

}  // namespace bccskel::cli
