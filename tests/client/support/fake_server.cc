#include "tests/client/support/fake_server.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/io/volume_encoder.h"
#include "proto/wire/result.h"
#include "proto/wire/skeleton_chunks.h"

namespace bccskel::client {
namespace {

v1::SkeletonizeResponse Accepted() {
  v1::SkeletonizeResponse response;
  response.mutable_accepted()->set_job("jobs/1");
  response.mutable_accepted()->set_max_chunk_bytes(1000);
  return response;
}

v1::SkeletonizeResponse Progress() {
  v1::SkeletonizeResponse response;
  response.mutable_shell_progress()->set_shell(1);
  response.mutable_shell_progress()->set_last_shell(2);
  return response;
}

}  // namespace

FakeServer::FakeServer(Script script, LabelsScript labels_script)
    : address_("unix:" + folder_ / "socket"),
      service_(std::move(script), std::move(labels_script)) {
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address_, grpc::InsecureServerCredentials());
  builder.RegisterService(&service_);
  server_ = builder.BuildAndStart();
  EXPECT_NE(server_, nullptr);
}

FakeServer::~FakeServer() {
  server_->Shutdown(std::chrono::system_clock::now());
  server_->Wait();
}

ReceivedCall ReadCall(FakeServer::Stream& stream) {
  ReceivedCall call;
  v1::SkeletonizeRequest request;
  if (stream.Read(&request)) call.config = request.config();
  stream.Write(Accepted());
  while (!call.finished && stream.Read(&request)) {
    if (request.has_chunk()) {
      EXPECT_EQ(request.chunk().offset(), call.bytes.size());
      EXPECT_LE(request.chunk().data().size(), 1000);
      call.bytes += request.chunk().data();
    } else {
      call.finish = request.finish();
      call.finished = true;
    }
  }
  return call;
}

std::vector<v1::SkeletonizeResponse> RepliesFor(const SkeletonizeResult& result) {
  std::vector<v1::SkeletonizeResponse> replies = {Accepted(), Progress()};
  wire::SkeletonChunkPager pager(result.graph);
  while (auto chunk = pager.Next()) {
    *replies.emplace_back().mutable_skeleton_chunk() = *std::move(chunk);
  }
  const std::string thin = *EncodeVolume(
      result.thin, {.encoding = VolumeEncoding::kBricks, .compression = VolumeCompression::kZstd},
      {});
  v1::ThinVolumeChunk& thin_chunk = *replies.emplace_back().mutable_thin_volume_chunk();
  thin_chunk.set_data(thin);
  wire::JobFacts facts;
  facts.thin_volume_size_bytes = thin.size();
  *replies.emplace_back().mutable_summary() = wire::SummaryOf(result, facts);
  return replies;
}

}  // namespace bccskel::client
