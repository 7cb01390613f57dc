#include "tests/fuzz/durable_fixture.h"

#include <memory>

#include "bccskel/v1/volume_service.pb.h"
#include "core/digest/sha256.h"
#include "server/calls/message_codec.h"
#include "server/calls/requests.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

// Never asked: DurableJobs' jobs wait.
class NoRunner final : public JobRunner {
 public:
  absl::StatusOr<std::shared_ptr<Job>> Start(JobRequest, std::shared_ptr<JobListener>) override {
    std::abort();
  }
  absl::StatusOr<std::shared_ptr<Job>> Start(LabelsRequest,
                                             std::shared_ptr<LabelsListener>) override {
    std::abort();
  }
};

class KeptJobs {
 public:
  KeptJobs() {
    Sha256Of("");  // so that OpenSSL ends after this object
    DurableOptions options;
    options.data_directory = folder_.path();
    options.max_runs = 0;
    options.max_tenant_disk_bytes = uint64_t{64} << 20;
    options.algorithm_version = "1";
    durable_jobs_ = *DurableJobs::Open(options, runner_, codec_);
  }
  DurableJobs& operator*() { return *durable_jobs_; }

 private:
  const test::TemporaryFolder folder_;
  NoRunner runner_;
  const MessageCodec codec_{kLimits};
  std::unique_ptr<DurableJobs> durable_jobs_;
};

// Of a cell without points.
constexpr uint64_t kCellBytes = 8;
std::string CellDeclaration() {
  v1::VolumeDeclaration declaration;
  declaration.set_encoding(v1::VOLUME_ENCODING_RAW_PLANES);
  declaration.mutable_extent()->set_nx(1);
  declaration.mutable_extent()->set_ny(1);
  declaration.mutable_extent()->set_nz(1);
  declaration.set_size_bytes(kCellBytes);
  return declaration.SerializeAsString();
}

std::string BeginCell(const std::string& name) {
  return Upload({.name = name, .declaration = CellDeclaration()})->name;
}

std::string MakeVolume() {
  const std::string upload = BeginCell("uploads/volume");
  Insist(Ask<uint64_t>([&](auto done) {
           TheJobs().Append(kTenant, upload, 0, std::string(kCellBytes, '\0'), {}, std::move(done));
         }).ok());
  return Ask<VolumeInfo>([&](auto done) {
           TheJobs().FinishUpload(kTenant, upload, kCellBytes, {}, std::move(done));
         })
      ->name;
}

std::string MakeJob() {
  NewJob job;
  job.volume = "volumes/known";
  return Create(std::move(job))->name;
}

}  // namespace

DurableJobs& TheJobs() {
  static KeptJobs kept;
  return *kept;
}

absl::StatusOr<UploadInfo> Upload(const NewUpload& wanted) {
  auto found = Ask<UploadInfo>(
      [&](auto done) { TheJobs().GetUpload(kTenant, wanted.name, std::move(done)); });
  if (!absl::IsNotFound(found.status())) return found;
  return Ask<UploadInfo>(
      [&](auto done) { TheJobs().CreateUpload(kTenant, wanted, std::move(done)); });
}

absl::StatusOr<JobInfo> Create(NewJob job) {
  job.volume = VolumeNamed(job.volume);
  return Ask<JobInfo>([&](auto done) { TheJobs().CreateJob(kTenant, job, std::move(done)); });
}

absl::Status DeleteUpload(const std::string& upload) {
  return Tell([&](auto done) { TheJobs().DeleteUpload(kTenant, upload, std::move(done)); });
}

absl::Status DeleteJob(const std::string& job) {
  return Tell([&](auto done) { TheJobs().DeleteJob(kTenant, job, std::move(done)); });
}

const std::string& VolumeNamed(const std::string& name) {
  if (name != "volumes/known") return name;
  static const std::string known = MakeVolume();
  return known;
}

const std::string& JobNamed(const std::string& name) {
  if (name != "jobs/known") return name;
  static const std::string known = MakeJob();
  return known;
}

std::string SpareJob(const std::string& name) { return name == "jobs/known" ? MakeJob() : name; }

std::string SpareUpload(const std::string& name) {
  return name == "uploads/known" ? BeginCell("uploads/spare") : name;
}

}  // namespace bccskel::server
