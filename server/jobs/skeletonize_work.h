#ifndef BCCSKEL_SERVER_JOBS_SKELETONIZE_WORK_H_
#define BCCSKEL_SERVER_JOBS_SKELETONIZE_WORK_H_

#include <memory>
#include <optional>

#include "core/volume/volume.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/job_work.h"
#include "server/jobs/volume_receiver.h"

namespace bccskel::server {

// One volume, one skeleton, in one turn.
class SkeletonizeWork final : public JobWork {
 public:
  SkeletonizeWork(JobRequest request, const VolumeLimits& limits,
                  VolumeReceiver::MakeDecoder make_decoder, std::shared_ptr<JobListener> listener);

  absl::Status Append(std::string_view bytes, const exec::Context& context) override;
  absl::Status Finish(const std::optional<Sha256Digest>& expected,
                      const exec::Context& context) override;
  uint64_t BytesToRun() const override;
  int MostThreads(int threads) const override;
  uint64_t Bricks() const override { return volume_->brick_count(); }
  absl::StatusOr<Turn> Run(exec::Context context, const std::shared_ptr<exec::MemoryBudget>& memory,
                           const std::function<void()>& wake) override;
  uint64_t ObjectPoints() const override { return result_.skeleton.object_points; }
  void End(absl::Status status, const JobTimes& times, Ticket ticket) override;

 private:
  absl::Status CountBricks(const exec::Context& context);
  OnShellPoints ShellPointsTeller();
  absl::Status CheckShellPoints() const;

  const JobRequest request_;
  std::shared_ptr<JobListener> listener_;
  std::unique_ptr<VolumeReceiver> receiver_;
  std::optional<Volume> volume_;
  uint64_t bricks_ = 0;  // of the volume, with its cavities filled if that is wanted
  std::optional<BettiNumbers> mask_topology_;
  JobResult result_;
  uint64_t shell_points_bytes_ = 0;  // told to the listener
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_SKELETONIZE_WORK_H_
