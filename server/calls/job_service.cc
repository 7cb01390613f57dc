#include <string>

#include "server/calls/durable_calls.h"
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

// For every response that holds one job.
template <typename Response>
auto AnswerJob(UnaryEnd end, Response* response) {
  return [end = std::move(end), response](const absl::StatusOr<JobInfo>& job) mutable {
    if (job.ok()) {
      *response->mutable_job() = ToMessage(*job);
      end.set_subject(job->name);
    }
    end(StorageError(job.status()));
  };
}

}  // namespace

grpc::ServerUnaryReactor* JobService::CreateJob(grpc::CallbackServerContext* context,
                                                const v1::CreateJobRequest* request,
                                                v1::CreateJobResponse* response) {
  return ServeUnary(gate_, *context, kCreateJob, {"volume", request->volume()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      absl::StatusOr<NewJob> job = NewJobOf(*request);
                      if (!job.ok()) {
                        end(job.status());
                        return;
                      }
                      job->trace = call.facts.trace;
                      call.durable_jobs.CreateJob(call.tenant(), *job, AnswerJob(end, response));
                    });
}

grpc::ServerUnaryReactor* JobService::GetJob(grpc::CallbackServerContext* context,
                                             const v1::GetJobRequest* request,
                                             v1::GetJobResponse* response) {
  return ServeUnary(gate_, *context, kGetJob, {"job", request->job()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      call.durable_jobs.GetJob(call.tenant(), request->job(),
                                               AnswerJob(end, response));
                    });
}

grpc::ServerUnaryReactor* JobService::ListJobs(grpc::CallbackServerContext* context,
                                               const v1::ListJobsRequest* request,
                                               v1::ListJobsResponse* response) {
  const absl::StatusOr<DurableCall> call = gate_.Enter(*context, kListJobs);
  if (!call.ok()) return EndUnary(*context, call.status());
  const UnaryEnd end(*context, call->facts, std::string());
  const absl::StatusOr<JobQuery> query = QueryOf(*request);
  if (!query.ok()) return end(query.status());
  call->durable_jobs.ListJobs(call->tenant(), *query, Answer(end, [response](const JobPage& page) {
                                for (const JobInfo& job : page.jobs) {
                                  *response->add_jobs() = ToMessage(job);
                                }
                                response->set_next_page_token(page.next_token);
                              }));
  return end.reactor();
}

grpc::ServerUnaryReactor* JobService::CancelJob(grpc::CallbackServerContext* context,
                                                const v1::CancelJobRequest* request,
                                                v1::CancelJobResponse* response) {
  return ServeUnary(gate_, *context, kCancelJob, {"job", request->job()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      call.durable_jobs.CancelJob(call.tenant(), request->job(),
                                                  AnswerJob(end, response));
                    });
}

grpc::ServerUnaryReactor* JobService::DeleteJob(grpc::CallbackServerContext* context,
                                                const v1::DeleteJobRequest* request,
                                                v1::DeleteJobResponse*) {
  return ServeUnary(gate_, *context, kDeleteJob, {"job", request->job()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      call.durable_jobs.DeleteJob(call.tenant(), request->job(),
                                                  AnswerNothing(end));
                    });
}

grpc::ServerWriteReactor<v1::WatchJobResponse>* JobService::WatchJob(
    grpc::CallbackServerContext* context, const v1::WatchJobRequest* request) {
  return StartWatch(gate_.Enter(*context, kWatchJob, {"job", request->job()}), *request);
}

grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* JobService::ReadSkeleton(
    grpc::CallbackServerContext* context, const v1::ReadSkeletonRequest* request) {
  return StartRead(gate_.Enter(*context, kReadSkeleton, {"job", request->job()}), *request);
}

}  // namespace bccskel::server
