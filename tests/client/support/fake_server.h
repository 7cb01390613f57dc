#ifndef BCCSKEL_TESTS_CLIENT_SUPPORT_FAKE_SERVER_H_
#define BCCSKEL_TESTS_CLIENT_SUPPORT_FAKE_SERVER_H_

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::client {

// A server on a unix socket that says what a test tells it to say, sense or nonsense.
class FakeServer {
 public:
  using Stream = grpc::ServerReaderWriter<v1::SkeletonizeResponse, v1::SkeletonizeRequest>;
  using Script = std::function<grpc::Status(grpc::ServerContext&, Stream&)>;

  using LabelsStream =
      grpc::ServerReaderWriter<v1::SkeletonizeLabelsResponse, v1::SkeletonizeLabelsRequest>;
  using LabelsScript = std::function<grpc::Status(LabelsStream&)>;

  explicit FakeServer(Script script) : FakeServer(std::move(script), nullptr) {}
  explicit FakeServer(LabelsScript script) : FakeServer(nullptr, std::move(script)) {}
  ~FakeServer();

  const std::string& address() const { return address_; }

 private:
  class Service : public v1::SkeletonizationService::Service {
   public:
    Service(Script script, LabelsScript labels_script)
        : script_(std::move(script)), labels_script_(std::move(labels_script)) {}
    grpc::Status Skeletonize(grpc::ServerContext* context, Stream* stream) override {
      return script_(*context, *stream);
    }
    grpc::Status SkeletonizeLabels(grpc::ServerContext*, LabelsStream* stream) override {
      return labels_script_(*stream);
    }

   private:
    Script script_;
    LabelsScript labels_script_;
  };

  FakeServer(Script script, LabelsScript labels_script);

  const test::TemporaryFolder folder_;
  std::string address_;
  Service service_;
  std::unique_ptr<grpc::Server> server_;
};

// What a client sent, read until its finish message or the end of its requests.
struct ReceivedCall {
  v1::SkeletonizeConfig config;
  std::string bytes;
  v1::VolumeFinish finish;
  bool finished = false;
};
ReceivedCall ReadCall(FakeServer::Stream& stream);

// The replies of an honest server, `accepted` first and the summary last.
std::vector<v1::SkeletonizeResponse> RepliesFor(const SkeletonizeResult& result);

}  // namespace bccskel::client

#endif  // BCCSKEL_TESTS_CLIENT_SUPPORT_FAKE_SERVER_H_
