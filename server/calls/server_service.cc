#include <memory>
#include <string>
#include <utility>

#include "bccskel/v1/admin_service.grpc.pb.h"
#include "bccskel/v1/server_service.grpc.pb.h"
#include "core/pipeline/algorithm_version.h"
#include "core/version/version.h"
#include "proto/wire/duration.h"
#include "proto/wire/labels.h"
#include "server/calls/request_sequence.h"
#include "server/calls/services.h"
#include "server/calls/unary_answer.h"

namespace bccskel::server {
namespace {

constexpr Method kGetCapabilities{"ServerService/GetCapabilities", Method::Kind::kQuestion};

void Set(v1::ServerLimits& message, const JobPool::Limits& limits) {
  message.set_max_volume_bytes(limits.max_volume_bytes);
  message.set_max_bricks(limits.volume.max_bricks);
  message.set_max_admitted_bytes(limits.max_bytes);
  message.set_max_jobs(static_cast<uint32_t>(limits.max_jobs));
  message.set_max_queue(static_cast<uint32_t>(limits.max_queue));
  message.set_threads(static_cast<uint32_t>(limits.threads));
  message.set_max_chunk_bytes(kMaxChunkBytes);
  message.set_max_message_bytes(kMaxMessageBytes);
  message.set_max_decoded_bytes(limits.volume.max_decoded_bytes);
}

void Set(v1::Durability& message, const DurableOptions& durable) {
  message.set_durable(true);
  *message.mutable_keep_uploads() = wire::DurationMessage(durable.keep_uploads);
  *message.mutable_keep_volumes() = wire::DurationMessage(durable.keep_volumes);
  *message.mutable_keep_jobs() = wire::DurationMessage(durable.keep_results);
  message.set_max_disk_bytes(durable.max_disk_bytes);
  message.set_max_tenant_disk_bytes(durable.max_tenant_disk_bytes);
  message.set_max_unfinished_jobs(static_cast<uint32_t>(durable.max_unfinished_jobs));
}

constexpr Method kGetServerStatus{"AdminService/GetServerStatus", Method::Kind::kQuestion};

class ServerService final : public v1::ServerService::CallbackService {
 public:
  ServerService(const CallGate& gate, const JobPool::Limits& limits, const DurableOptions& durable)
      : gate_(gate), limits_(limits), durable_(durable) {}

  grpc::ServerUnaryReactor* GetCapabilities(Context* context, const v1::GetCapabilitiesRequest*,
                                            v1::GetCapabilitiesResponse* response) override {
    const absl::StatusOr<CallFacts> facts = gate_.Enter(*context, kGetCapabilities);
    if (!facts.ok()) return EndUnary(*context, facts.status());
    response->set_server_version(std::string(Version()));
    response->set_algorithm_version(kAlgorithmVersion);
    response->add_api_versions("v1");
    response->add_encodings(v1::VOLUME_ENCODING_OPENEXR);
    response->add_encodings(v1::VOLUME_ENCODING_RAW_PLANES);
    response->add_encodings(v1::VOLUME_ENCODING_BRICKS);
    response->add_encodings(v1::VOLUME_ENCODING_CUBIC_MASK);
    response->add_compressions(v1::VOLUME_COMPRESSION_NONE);
    response->add_compressions(v1::VOLUME_COMPRESSION_ZSTD);
    for (int bytes : {1, 2, 4, 8}) response->add_label_types(wire::LabelTypeOf(bytes));
    Set(*response->mutable_limits(), limits_);
    if (gate_.durable_jobs() != nullptr) Set(*response->mutable_durability(), durable_);
    return UnaryEnd(*context, *facts, std::string())(absl::OkStatus());
  }

 private:
  const CallGate& gate_;
  const JobPool::Limits limits_;
  const DurableOptions durable_;
};

class AdminService final : public v1::AdminService::CallbackService {
 public:
  AdminService(const CallGate& gate, StatusSource status)
      : gate_(gate), status_(std::move(status)) {}

  grpc::ServerUnaryReactor* GetServerStatus(Context* context, const v1::GetServerStatusRequest*,
                                            v1::GetServerStatusResponse* response) override {
    const absl::StatusOr<CallFacts> facts = gate_.EnterAsAdmin(*context, kGetServerStatus);
    if (!facts.ok()) return EndUnary(*context, facts.status());
    *response = status_();
    return UnaryEnd(*context, *facts, std::string())(absl::OkStatus());
  }

 private:
  const CallGate& gate_;
  const StatusSource status_;
};

}  // namespace

std::unique_ptr<grpc::Service> MakeServerService(const CallGate& gate,
                                                 const JobPool::Limits& limits,
                                                 const DurableOptions& durable) {
  return std::make_unique<ServerService>(gate, limits, durable);
}

std::unique_ptr<grpc::Service> MakeAdminService(const CallGate& gate, StatusSource status) {
  return std::make_unique<AdminService>(gate, std::move(status));
}

}  // namespace bccskel::server
