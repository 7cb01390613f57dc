#include <memory>
#include <string>
#include <utility>

#include "bccskel/v1/job_service.grpc.pb.h"
#include "core/exec/status_macros.h"
#include "server/calls/durable_messages.h"
#include "server/calls/services.h"
#include "server/calls/unary_answer.h"

namespace bccskel::server {
namespace {

constexpr Method kCreateJob{"JobService/CreateJob"};
constexpr Method kGetJob{"JobService/GetJob", Method::Kind::kQuestion};
constexpr Method kListJobs{"JobService/ListJobs", Method::Kind::kQuestion};
constexpr Method kCancelJob{"JobService/CancelJob"};
constexpr Method kDeleteJob{"JobService/DeleteJob"};
constexpr Method kWatchJob{"JobService/WatchJob"};
constexpr Method kReadSkeleton{"JobService/ReadSkeleton"};

// Answers with a response that holds one job.
template <typename Response>
auto AnswerJob(Response* response) {
  return [response](UnaryEnd end) {
    return [end = std::move(end), response](const absl::StatusOr<JobInfo>& job) mutable {
      if (job.ok()) {
        *response->mutable_job() = ToMessage(*job);
        end.set_subject(job->name);
      }
      end(StorageError(job.status()));
    };
  };
}

class JobService final : public v1::JobService::CallbackService {
 public:
  explicit JobService(const CallGate& gate) : gate_(gate) {}

  grpc::ServerUnaryReactor* CreateJob(Context* context, const v1::CreateJobRequest* request,
                                      v1::CreateJobResponse* response) override {
    const std::string& volume = request->volume();
    const auto read = [&](const DurableCall& call) -> absl::StatusOr<NewJob> {
      BCCSKEL_ASSIGN_OR_RETURN(NewJob job, NewJobOf(*request));
      job.trace = call.facts.trace;
      return job;
    };
    return AskDurable(*context,
                      gate_.EnterDurable(*context, kCreateJob, CallGate::Name{"volume", volume}),
                      volume, read, &DurableJobs::CreateJob, AnswerJob(response));
  }
  grpc::ServerUnaryReactor* GetJob(Context* context, const v1::GetJobRequest* request,
                                   v1::GetJobResponse* response) override {
    return AskDurable(gate_, *context, kGetJob, {"job", request->job()}, &DurableJobs::GetJob,
                      AnswerJob(response));
  }
  grpc::ServerUnaryReactor* ListJobs(Context* context, const v1::ListJobsRequest* request,
                                     v1::ListJobsResponse* response) override {
    return AskDurable(
        *context, gate_.EnterDurable(*context, kListJobs), std::string(),
        [&](const DurableCall&) { return QueryOf(*request); }, &DurableJobs::ListJobs,
        Answer([response](const JobPage& page) {
          for (const JobInfo& job : page.jobs) {
            v1::Job& message = *response->add_jobs() = ToMessage(job);
            message.mutable_options()->clear_keep();
          }
          response->set_next_page_token(page.next_token);
        }));
  }
  grpc::ServerUnaryReactor* CancelJob(Context* context, const v1::CancelJobRequest* request,
                                      v1::CancelJobResponse* response) override {
    return AskDurable(gate_, *context, kCancelJob, {"job", request->job()}, &DurableJobs::CancelJob,
                      AnswerJob(response));
  }
  grpc::ServerUnaryReactor* DeleteJob(Context* context, const v1::DeleteJobRequest* request,
                                      v1::DeleteJobResponse*) override {
    return AskDurable(gate_, *context, kDeleteJob, {"job", request->job()}, &DurableJobs::DeleteJob,
                      AnswerNothing);
  }
  grpc::ServerWriteReactor<v1::WatchJobResponse>* WatchJob(
      Context* context, const v1::WatchJobRequest* request) override {
    return StartWatch(
        gate_.EnterDurable(*context, kWatchJob, CallGate::Name{"job", request->job()}), *request);
  }
  grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* ReadSkeleton(
      Context* context, const v1::ReadSkeletonRequest* request) override {
    return StartRead(
        gate_.EnterDurable(*context, kReadSkeleton, CallGate::Name{"job", request->job()}),
        *request);
  }

 private:
  const CallGate& gate_;
};

}  // namespace

std::unique_ptr<grpc::Service> MakeJobService(const CallGate& gate) {
  return std::make_unique<JobService>(gate);
}

}  // namespace bccskel::server
