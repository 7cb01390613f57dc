#include "server/server.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "bccskel/v1/admin_service.grpc.pb.h"
#include "bccskel/v1/job_service.grpc.pb.h"
#include "bccskel/v1/server_service.grpc.pb.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "bccskel/v1/volume_service.grpc.pb.h"
#include "core/exec/status_macros.h"
#include "core/pipeline/algorithm_version.h"
#include "core/version/version.h"
#include "proto/address/address.h"
#include "proto/wire/duration.h"
#include "server/admission/memory_estimate.h"
#include "server/calls/call_gate.h"
#include "server/calls/durable_messages.h"
#include "server/calls/message_codec.h"
#include "server/calls/services.h"
#include "server/calls/status_mapping.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"
#include "server/identity/tls_files.h"
#include "server/listener.h"
#include "server/logging/json_log.h"
#include "server/metrics/call_meter.h"

namespace bccskel::server {
namespace {

// Time for calls without a job, such as a watched health status, to end by themselves.
constexpr std::chrono::milliseconds kLastReplies(100);
// Time for the answers of unary calls, which mostly wait for the disk.
constexpr std::chrono::seconds kLastAnswers(5);

// "QUEUED", "RUNNING", ...
std::string StateName(JobState state) {
  return v1::JobState_Name(ToMessage(state)).substr(std::size("JOB_STATE_") - 1);
}

LogLevel LevelOf(const JobRow& job) {
  if (job.state != JobState::kFailed) return LogLevel::kInfo;
  return absl::IsInternal(job.error) ? LogLevel::kError : LogLevel::kWarning;
}

// Logs a new state of a durable job.
void LogJobState(const JobRow& job) {
  const absl::Status error = WithJobReason(job.error);
  const auto since_created = job.ended.value_or(job.started.value_or(job.created)) - job.created;
  Log(LevelOf(job), "job state",
      {{"job", job.name},
       {"tenant", job.tenant},
       {"state", StateName(job.state)},
       {"attempt", int64_t{job.attempts}},
       {"code", absl::StatusCodeToString(error.code())},
       {"reason", ReasonNameOf(error)},
       {"message", std::string(error.message())},
       {"seconds", std::chrono::duration<double>(since_created).count()},
       {"traceparent", job.trace}});
}

// A limit below which no volume, however small, can be computed or kept.
void WarnOf(const char* setting, uint64_t limit, uint64_t least) {
  if (limit >= least) return;
  Log(LogLevel::kWarning, "limit too small",
      {{"message", absl::StrCat(setting, " is ", limit, ": no job can run with less than ", least,
                                " bytes")}});
}

void WarnOfLimits(const ServerConfig& config) {
  // Less than the summary of any result takes, beside its volume.
  constexpr uint64_t kLeastDiskBytes = 256;
  WarnOf("max-memory-bytes", config.limits.max_bytes, kFixedJobBytes + kPipelineBytesPerBrick);
  if (config.durable.data_directory.empty()) return;
  const DurableOptions& durable = config.durable;
  if (durable.max_disk_bytes > 0) WarnOf("max-disk-bytes", durable.max_disk_bytes, kLeastDiskBytes);
  if (durable.max_tenant_disk_bytes > 0) {
    WarnOf("max-tenant-disk-bytes", durable.max_tenant_disk_bytes, kLeastDiskBytes);
  }
}

// A network reaches neither reflection nor admin calls unless configured so.
bool AdminsShareThePublicListener(const ServerConfig& config) {
  return config.admin_listen.empty() && std::ranges::all_of(config.listen, IsOfThisMachine);
}

void LogReload(const char* what, const absl::StatusOr<Reload>& reload,
               std::initializer_list<LogField> fields = {}) {
  if (!reload.ok()) {
    return Log(LogLevel::kError, absl::StrCat(what, " not reloaded"),
               {{"message", std::string(reload.status().message())}});
  }
  if (*reload == Reload::kDone) Log(LogLevel::kInfo, absl::StrCat(what, " reloaded"), fields);
}

google::protobuf::Duration DurationOf(std::chrono::duration<double> time) {
  return wire::DurationMessage(std::chrono::duration_cast<std::chrono::nanoseconds>(time));
}

void Set(v1::StoredNow& message, const DurableUsage& stored) {
  message.set_disk_used_bytes(stored.disk_bytes);
  message.set_disk_available_bytes(stored.disk_available_bytes);
  message.set_uploads_unfinished(static_cast<uint32_t>(stored.uploads));
  message.set_jobs_queued(static_cast<uint32_t>(stored.queued));
  message.set_jobs_running(static_cast<uint32_t>(stored.running));
}

void Set(v1::GetServerStatusResponse& message, const ServerGauges& now) {
  message.set_draining(now.draining != 0);
  message.mutable_jobs()->set_admitted(static_cast<uint32_t>(now.admitted_jobs));
  message.mutable_jobs()->set_waiting(static_cast<uint32_t>(now.computing.waiting));
  message.mutable_jobs()->set_running(static_cast<uint32_t>(now.computing.running));
  message.set_threads(static_cast<uint32_t>(now.threads));
  message.set_busy_threads(static_cast<uint32_t>(now.computing.busy_threads));
  message.set_admitted_bytes(now.admitted_bytes);
  message.set_max_admitted_bytes(now.max_admitted_bytes);
  if (now.stored.has_value()) Set(*message.mutable_stored(), *now.stored);
}

void Set(v1::ServerTotals& message, const ServerSums& sums) {
  message.set_calls(sums.calls);
  message.set_failed_calls(sums.failed_calls);
  message.set_jobs(sums.jobs);
  message.set_failed_jobs(sums.failed_jobs);
  message.set_object_points(sums.object_points);
}

// The response of AdminService for a server started at `started`.
v1::GetServerStatusResponse StatusOf(const ServerMetrics& metrics,
                                     std::chrono::steady_clock::time_point started) {
  v1::GetServerStatusResponse response;
  response.set_server_version(std::string(Version()));
  *response.mutable_uptime() = DurationOf(std::chrono::steady_clock::now() - started);
  Set(response, metrics.gauges());
  const ProcessFigures process = ReadProcessFigures();
  response.set_resident_bytes(process.resident_bytes);
  response.set_open_files(static_cast<uint32_t>(process.open_files));
  *response.mutable_processor_time() = DurationOf(process.processor_time);
  Set(*response.mutable_totals(), metrics.sums());
  return response;
}

}  // namespace

class Server::Services {
 public:
  Services(const ServerConfig& config, const Callers& callers, JobRunner& runner,
           DurableJobs* durable_jobs, ServerMetrics& metrics)
      : gate_(callers, config.caller_timeouts, durable_jobs),
        skeletonization_(MakeSkeletonizationService(gate_, runner, config.limits.volume, writers_)),
        volumes_(MakeVolumeService(gate_, writers_, config.limits)),
        jobs_(MakeJobService(gate_)),
        server_(MakeServerService(gate_, config.limits, config.durable)),
        admin_(MakeAdminService(gate_, [this, &metrics] { return StatusOf(metrics, started_); })) {}

  void AddPublic(ListenerPlan& plan) {
    Add(plan, *skeletonization_, v1::SkeletonizationService::service_full_name());
    Add(plan, *volumes_, v1::VolumeService::service_full_name());
    Add(plan, *jobs_, v1::JobService::service_full_name());
    Add(plan, *server_, v1::ServerService::service_full_name());
  }
  void CutOff() { gate_.CutOff(kLastAnswers); }
  void EnforceCallLimits() { gate_.EnforceCallLimits(); }
  void AddAdmin(ListenerPlan& plan) {
    Add(plan, *admin_, v1::AdminService::service_full_name());
    plan.reflection = ListenerPlan::Reflection::kOn;
  }

 private:
  static void Add(ListenerPlan& plan, grpc::Service& service, const char* name) {
    plan.services.push_back(&service);
    plan.healthy.emplace_back(name);
  }

  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  CallGate gate_;
  UploadWriters writers_;
  const std::unique_ptr<grpc::Service> skeletonization_, volumes_, jobs_, server_, admin_;
};

Server::Server(const ServerConfig& config, std::unique_ptr<Callers> callers)
    : config_(config),
      callers_(std::move(callers)),
      metrics_([this] { return Gauges(); }),
      jobs_(config.limits,
            {.on_admitted = [this](uint64_t volume_bytes) { metrics_.CountAdmitted(volume_bytes); },
             .on_end = [this](const JobEnd& end) { metrics_.Count(end); }}),
      codec_(std::make_unique<MessageCodec>(config_.limits.volume)),
      certificates_(config.tls.enabled() ? std::make_unique<ServedCertificates>(config.tls)
                                         : nullptr) {}

Server::~Server() {
  metrics_.Hide();
  for (const auto* listener : {&public_listener_, &admin_listener_}) {
    if (*listener != nullptr) (*listener)->Shutdown(std::chrono::milliseconds(0));
  }
}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerConfig& config) {
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<Callers> callers, Callers::Create(config.tokens));
  std::unique_ptr<Server> server(new Server(config, std::move(callers)));
  server->SetTenants();
  BCCSKEL_RETURN_IF_ERROR(server->OpenData());
  BCCSKEL_RETURN_IF_ERROR(server->Listen());
  BCCSKEL_RETURN_IF_ERROR(server->ListenForAdmins());
  BCCSKEL_RETURN_IF_ERROR(server->ShowMetrics());
  WarnOfLimits(config);
  return server;
}

absl::Status Server::OpenData() {
  if (!config_.durable.data_directory.empty()) {
    DurableOptions options = config_.durable;
    options.max_job_bytes = config_.limits.max_bytes;
    options.max_runs = config_.limits.max_jobs;
    options.tenants = [this] { return TenantTable{.each = {}, .named = callers_->tenants()}; };
    options.algorithm_version = std::string(kAlgorithmVersion);
    metrics_.ExpectDurableJobs();
    options.on_job_state = [this](const JobRow& job) {
      LogJobState(job);
      if (!IsTerminal(job.state)) return;
      const bool cancelled = job.state == JobState::kCancelled;
      const absl::Status end = cancelled ? absl::CancelledError() : WithJobReason(job.error);
      metrics_.CountDurable(absl::StatusCodeToString(end.code()), ReasonNameOf(end));
    };
    options.on_warning = [](const std::string& warning) {
      Log(LogLevel::kWarning, "data", {{"message", warning}});
    };
    BCCSKEL_ASSIGN_OR_RETURN(durable_jobs_, DurableJobs::Open(options, jobs_, *codec_));
  }
  services_ = std::make_unique<Services>(config_, *callers_, jobs_, durable_jobs_.get(), metrics_);
  return absl::OkStatus();
}

absl::Status Server::Listen() {
  if (certificates_ != nullptr) BCCSKEL_RETURN_IF_ERROR(certificates_->ReloadIfChanged().status());
  ListenerPlan plan;
  plan.addresses = config_.listen;
  plan.tls = certificates_.get();
  services_->AddPublic(plan);
  if (AdminsShareThePublicListener(config_)) services_->AddAdmin(plan);
  for (const std::string& service : plan.healthy) ExpectCallsOf(service, metrics_);
  plan.metrics = &metrics_;
  BCCSKEL_ASSIGN_OR_RETURN(public_listener_, Listener::Start(std::move(plan)));
  const bool for_anyone = config_.tokens.empty() && config_.tls.client_ca.empty();
  for (const std::string& address : addresses()) {
    Log(LogLevel::kInfo, "listening", {{"address", address}});
    if (!for_anyone || IsOfThisMachine(address)) continue;
    Log(LogLevel::kWarning, "open to all",
        {{"address", address},
         {"message", "whoever reaches it may call: see --tokens and --tls-client-ca"}});
  }
  return absl::OkStatus();
}

absl::Status Server::ListenForAdmins() {
  if (config_.admin_listen.empty()) return absl::OkStatus();
  ListenerPlan plan;
  plan.addresses = {config_.admin_listen};
  plan.tls = certificates_.get();
  services_->AddAdmin(plan);
  BCCSKEL_ASSIGN_OR_RETURN(admin_listener_, Listener::Start(std::move(plan)));
  Log(LogLevel::kInfo, "listening for admins", {{"address", admin_address()}});
  return absl::OkStatus();
}

absl::Status Server::ShowMetrics() {
  if (config_.metrics_listen.empty()) return absl::OkStatus();
  BCCSKEL_RETURN_IF_ERROR(metrics_.Show(config_.metrics_listen));
  Log(LogLevel::kInfo, "listening for metrics", {{"address", metrics_address()}});
  return absl::OkStatus();
}

ServerGauges Server::Gauges() const {
  ServerGauges now;
  now.admitted_jobs = jobs_.admitted_jobs();
  now.computing = jobs_.compute_usage();
  now.threads = config_.limits.threads;
  now.admitted_bytes = jobs_.admission_usage().bytes;
  now.max_admitted_bytes = config_.limits.max_bytes;
  now.draining = draining_ ? 1 : 0;
  now.dropped_log_lines = DroppedLogLines();
  if (certificates_ != nullptr) now.certificate_end = certificates_->end();
  if (durable_jobs_ != nullptr) now.stored = durable_jobs_->usage();
  return now;
}

const std::vector<std::string>& Server::addresses() const { return public_listener_->addresses(); }

std::string Server::admin_address() const {
  return admin_listener_ == nullptr ? "" : admin_listener_->addresses().front();
}

void Server::ReloadIfChanged() {
  TakeTokens(callers_->ReloadIfChanged());
  if (certificates_ != nullptr) LogReload("certificates", certificates_->ReloadIfChanged());
}

void Server::ReloadNow() { TakeTokens(callers_->ReloadNow()); }

void Server::EnforceCallLimits() { services_->EnforceCallLimits(); }

void Server::UpdateDataHealth() {
  DurableJobs* const durable_jobs = durable_jobs_.get();
  if (durable_jobs == nullptr) return;
  const absl::Status health = durable_jobs->Health();
  // Whoever balances load calls an unhealthy server no more.
  if (!health.ok()) durable_jobs->Probe();
  if (health.ok() == data_healthy_) return;
  data_healthy_ = health.ok();
  for (const char* service :
       {v1::JobService::service_full_name(), v1::VolumeService::service_full_name()}) {
    public_listener_->SetServing(service,
                                 data_healthy_ ? Listener::Serving::kYes : Listener::Serving::kNo);
  }
  Log(data_healthy_ ? LogLevel::kInfo : LogLevel::kError,
      data_healthy_                 ? "data is intact again"
      : absl::IsUnavailable(health) ? "data cannot be reached"
                                    : "data is damaged",
      {{"message", std::string(health.message())}});
}

void Server::SetTenants() { jobs_.SetTenants({.each = {}, .named = callers_->tenants()}); }

void Server::TakeTokens(const absl::StatusOr<Reload>& reload) {
  if (reload.ok() && *reload == Reload::kDone) SetTenants();
  LogReload("tokens", reload, {{"tenants", static_cast<int64_t>(callers_->tenants().size())}});
}

void Server::WaitLameDuckTime() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kBetweenChecks(1);
  const Clock::time_point end = Clock::now() + config_.lame_duck;
  for (Clock::time_point now = Clock::now(); now < end; now = Clock::now()) {
    ReloadIfChanged();
    EnforceCallLimits();
    std::this_thread::sleep_for(std::min<Clock::duration>(kBetweenChecks, end - now));
  }
}

void Server::Drain() {
  Log(LogLevel::kInfo, "draining", {{"jobs", int64_t{jobs_.admitted_jobs()}}});
  draining_ = true;
  public_listener_->SetServing(Listener::Serving::kNo);
  if (admin_listener_ != nullptr) admin_listener_->SetServing(Listener::Serving::kNo);
  WaitLameDuckTime();
  if (durable_jobs_ != nullptr) durable_jobs_->StopAdmitting();
  jobs_.StopAdmitting();
  jobs_.WaitUntilEmpty(config_.drain);
  services_->CutOff();
  public_listener_->Shutdown(kLastReplies);
  if (admin_listener_ != nullptr) admin_listener_->Shutdown(kLastReplies);
  Log(LogLevel::kInfo, "drained");
}

}  // namespace bccskel::server
