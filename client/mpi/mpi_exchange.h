#ifndef BCCSKEL_CLIENT_MPI_MPI_EXCHANGE_H_
#define BCCSKEL_CLIENT_MPI_MPI_EXCHANGE_H_

#include <mpi.h>

#include <array>
#include <cstdint>

#include "core/ranks/exchange.h"

namespace bccskel::cli {

// What a rank has sent so far.
struct ExchangeCounts {
  uint64_t trades = 0;
  uint64_t sums = 0;
  uint64_t messages = 0;  // each to one other rank
  uint64_t bytes = 0;     // in these
  double waited = 0;      // seconds in trades and sums, sending included
  int64_t peak = 0;       // peak memory until the end of the stage, KiB; 0: not run
};

// The ranks of an MPI job. Waits without occupying the processor: after 100 microseconds of polling
// it sleeps between polls. Errors of MPI end the job, by its default error handler.
// Needs: MPI is initialized before this and finalized after it; one thread at a time.
class MpiExchange : public ranks::Exchange {
 public:
  explicit MpiExchange(MPI_Comm communicator);
  ~MpiExchange() override;
  MpiExchange(const MpiExchange&) = delete;
  MpiExchange& operator=(const MpiExchange&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void Trade(std::span<const int> peers, std::span<const ranks::Bytes> out,
             std::span<ranks::Bytes> in) override;
  void Sum(std::span<uint64_t> numbers) override { Reduce(numbers, MPI_SUM); }
  void Max(std::span<uint64_t> numbers) override { Reduce(numbers, MPI_MAX); }

  void Enter(ranks::Stage stage) override;

  const ExchangeCounts& counts(ranks::Stage stage) const {
    return counts_[static_cast<size_t>(stage)];
  }

 private:
  void Reduce(std::span<uint64_t> numbers, MPI_Op operation);
  void Send(int peer, const ranks::Bytes& bytes, std::vector<MPI_Request>& requests);

  MPI_Comm communicator_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  ExchangeCounts& now() { return counts_[static_cast<size_t>(stage_)]; }

  ranks::Stage stage_ = ranks::Stage::kSharing;
  std::array<ExchangeCounts, ranks::kStageCount> counts_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_MPI_MPI_EXCHANGE_H_
