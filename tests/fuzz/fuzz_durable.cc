// Any bytes as what a caller of VolumeService and JobService sends: the first byte chooses the
// call, length-delimited requests follow. They go through the checks of order and fields to the
// real DurableJobs of durable_fixture.h. Every answer is OK or the caller's error with its details,
// never UNKNOWN or INTERNAL.
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bccskel/v1/job_service.pb.h"
#include "bccskel/v1/rpc_details.pb.h"
#include "bccskel/v1/volume_service.pb.h"
#include "core/digest/sha256.h"
#include "core/exec/status_macros.h"
#include "server/calls/durable_messages.h"
#include "server/calls/message_codec.h"
#include "server/calls/request_sequence.h"
#include "server/calls/requests.h"
#include "server/calls/status_mapping.h"
#include "tests/fuzz/durable_fixture.h"

namespace bccskel::server {
namespace {

class SilentWatcher final : public JobWatcher {
 public:
  void OnEvent(const JobEvent& event) override { ToMessage(event); }
  void OnWatchEnd(const absl::Status&) override {}
};

std::optional<Sha256Digest> DigestIn(const v1::VolumeFinish& finish) {
  Sha256Digest digest;
  if (finish.sha256().size() != digest.bytes.size()) return std::nullopt;
  std::ranges::copy(finish.sha256(), digest.bytes.begin());
  return digest;
}

// An upload as UploadVolume makes it.
class UploadCall {
 public:
  using Request = v1::UploadVolumeRequest;
  ~UploadCall() {
    if (name_.empty()) return;
    TheJobs().SenderGone(kTenant, name_);
    DeleteUpload(name_).IgnoreError();
  }

  absl::Status Take(Request& request) {
    BCCSKEL_RETURN_IF_ERROR(sequence_.Take(request));
    if (request.has_config()) return Open(request.config());
    return request.has_chunk() ? Append(*request.mutable_chunk()) : Finish(request.finish());
  }
  absl::Status HalfClose() { return sequence_.HalfClose(); }

 private:
  absl::Status Open(const v1::UploadVolumeConfig& config) {
    v1::SkeletonizeConfig whole;
    *whole.mutable_volume() = config.volume();
    BCCSKEL_RETURN_IF_ERROR(JobRequestOf(whole, kLimits).status());
    NewUpload wanted;
    wanted.name = config.upload();
    wanted.declaration = config.volume().SerializeAsString();
    BCCSKEL_ASSIGN_OR_RETURN(const UploadInfo upload, Upload(wanted));
    name_ = upload.name;
    ToMessage(upload);
    sequence_.ResumeAt(upload.committed_bytes);
    return absl::OkStatus();
  }
  absl::Status Append(v1::VolumeChunk& chunk) {
    std::optional<uint32_t> crc32c;
    if (chunk.has_crc32c()) crc32c = chunk.crc32c();
    return Ask<uint64_t>([&](auto done) {
             TheJobs().Append(kTenant, name_, chunk.offset(), std::move(*chunk.mutable_data()),
                              crc32c, std::move(done));
           })
        .status();
  }
  absl::Status Finish(const v1::VolumeFinish& finish) {
    const auto volume = Ask<VolumeInfo>([&](auto done) {
      TheJobs().FinishUpload(kTenant, name_, finish.size_bytes(), DigestIn(finish),
                             std::move(done));
    });
    if (!volume.ok()) return volume.status();
    return Tell([&](auto done) { TheJobs().DeleteVolume(kTenant, volume->name, std::move(done)); });
  }

  RequestSequence sequence_;
  std::string name_;
};

// Of calls with one request each; here one follows the other.
struct UnaryCall {
  static absl::Status HalfClose() { return absl::OkStatus(); }
};

struct CreateJobCall : UnaryCall {
  using Request = v1::CreateJobRequest;
  static absl::Status Take(const Request& request) {
    BCCSKEL_ASSIGN_OR_RETURN(const NewJob job, NewJobOf(request));
    BCCSKEL_ASSIGN_OR_RETURN(const JobInfo made, Create(job));
    const v1::Job message = ToMessage(made);
    Insist(message.request_id() == request.request_id());
    if (request.validate_only() || made.name == JobNamed("jobs/known")) return absl::OkStatus();
    return DeleteJob(made.name);
  }
};

struct ListJobsCall : UnaryCall {
  using Request = v1::ListJobsRequest;
  static absl::Status Take(const Request& request) {
    BCCSKEL_ASSIGN_OR_RETURN(const JobQuery query, QueryOf(request));
    BCCSKEL_ASSIGN_OR_RETURN(const JobPage page, Ask<JobPage>([&](auto done) {
                               TheJobs().ListJobs(kTenant, query, std::move(done));
                             }));
    Insist(page.jobs.size() <= static_cast<size_t>(query.page_size));
    for (const JobInfo& job : page.jobs) ToMessage(job);
    return absl::OkStatus();
  }
};

struct GetJobCall : UnaryCall {
  using Request = v1::GetJobRequest;
  static absl::Status Take(const Request& request) {
    const std::string& job = JobNamed(request.job());
    BCCSKEL_ASSIGN_OR_RETURN(const JobInfo info, Ask<JobInfo>([&](auto done) {
                               TheJobs().GetJob(kTenant, job, std::move(done));
                             }));
    Insist(ToMessage(info).name() == job);
    return absl::OkStatus();
  }
};

struct CancelJobCall : UnaryCall {
  using Request = v1::CancelJobRequest;
  static absl::Status Take(const Request& request) {
    const std::string job = SpareJob(request.job());
    BCCSKEL_ASSIGN_OR_RETURN(const JobInfo info, Ask<JobInfo>([&](auto done) {
                               TheJobs().CancelJob(kTenant, job, std::move(done));
                             }));
    Insist(info.state == JobState::kCancelled);
    return DeleteJob(job);
  }
};

struct DeleteJobCall : UnaryCall {
  using Request = v1::DeleteJobRequest;
  static absl::Status Take(const Request& request) { return DeleteJob(SpareJob(request.job())); }
};

struct WatchJobCall : UnaryCall {
  using Request = v1::WatchJobRequest;
  static absl::Status Take(const Request& request) {
    const std::string& job = JobNamed(request.job());
    const auto watch = TheJobs().WatchJob(kTenant, job, request.after_sequence(),
                                          std::make_shared<SilentWatcher>());
    return Ask<JobInfo>([&](auto done) { TheJobs().GetJob(kTenant, job, std::move(done)); })
        .status();
  }
};

struct ReadSkeletonCall : UnaryCall {
  using Request = v1::ReadSkeletonRequest;
  static absl::Status Take(const Request& request) {
    const auto reader = Ask<std::shared_ptr<ResultReader>>([&](auto done) {
      TheJobs().OpenResult(kTenant, JobNamed(request.job()), request.piece_index(),
                           std::move(done));
    });
    Insist(!reader.ok());  // no job has ended
    return reader.status();
  }
};

struct GetUploadStatusCall : UnaryCall {
  using Request = v1::GetUploadStatusRequest;
  static absl::Status Take(const Request& request) {
    const std::string upload = SpareUpload(request.upload());
    BCCSKEL_ASSIGN_OR_RETURN(const UploadInfo info, Ask<UploadInfo>([&](auto done) {
                               TheJobs().GetUpload(kTenant, upload, std::move(done));
                             }));
    Insist(ToMessage(info).name() == upload);
    return DeleteUpload(upload);
  }
};

struct DeleteUploadCall : UnaryCall {
  using Request = v1::DeleteUploadRequest;
  static absl::Status Take(const Request& request) {
    return DeleteUpload(SpareUpload(request.upload()));
  }
};

struct FindMissingVolumesCall : UnaryCall {
  using Request = v1::FindMissingVolumesRequest;
  static absl::Status Take(const Request& request) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<StoredKey> keys, KeysOf(request));
    std::vector<std::string> digests;
    for (const StoredKey& key : keys) digests.push_back(key.digest);
    return Ask<std::vector<VolumeInfo>>(
               [&](auto done) { TheJobs().FindVolumes(kTenant, digests, std::move(done)); })
        .status();
  }
};

struct DeleteVolumeCall : UnaryCall {
  using Request = v1::DeleteVolumeRequest;
  static absl::Status Take(const Request& request) {
    JobNamed("jobs/known");  // so that the known volume is needed
    const std::string& volume = VolumeNamed(request.volume());
    const absl::Status deleted =
        Tell([&](auto done) { TheJobs().DeleteVolume(kTenant, volume, std::move(done)); });
    Insist(!deleted.ok());
    return deleted;
  }
};

template <typename Call>
absl::Status Converse(google::protobuf::io::CodedInputStream& input) {
  Call call;
  typename Call::Request request;
  while (google::protobuf::util::ParseDelimitedFromCodedStream(&request, &input, nullptr)) {
    BCCSKEL_RETURN_IF_ERROR(call.Take(request));
    request.Clear();
  }
  return call.HalfClose();
}

using Answerer = absl::Status (*)(google::protobuf::io::CodedInputStream&);

// In the order of the seeds' first bytes.
constexpr Answerer kCalls[] = {
    &Converse<UploadCall>,
    &Converse<CreateJobCall>,
    &Converse<ListJobsCall>,
    &Converse<WatchJobCall>,
    &Converse<GetJobCall>,
    &Converse<CancelJobCall>,
    &Converse<DeleteJobCall>,
    &Converse<ReadSkeletonCall>,
    &Converse<GetUploadStatusCall>,
    &Converse<DeleteUploadCall>,
    &Converse<FindMissingVolumesCall>,
    &Converse<DeleteVolumeCall>,
};

void CheckAnswer(const absl::Status& status) {
  const grpc::Status answer = ToGrpcStatus(status);
  if (answer.ok()) return;
  Insist(answer.error_code() != grpc::UNKNOWN && answer.error_code() != grpc::INTERNAL &&
         answer.error_code() != grpc::DATA_LOSS);
  v1::Status details;
  Insist(details.ParseFromString(answer.error_details()) && details.details_size() > 0);
}

}  // namespace
}  // namespace bccskel::server

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bccskel::server;
  if (size == 0) return 0;
  google::protobuf::io::ArrayInputStream bytes(data + 1, static_cast<int>(size - 1));
  google::protobuf::io::CodedInputStream input(&bytes);
  CheckAnswer(kCalls[data[0] % std::size(kCalls)](input));
  return 0;
}
