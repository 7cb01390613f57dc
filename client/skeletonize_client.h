#ifndef BCCSKEL_CLIENT_SKELETONIZE_CLIENT_H_
#define BCCSKEL_CLIENT_SKELETONIZE_CLIENT_H_

#include <memory>

#include "absl/status/statusor.h"
#include "client/call_options.h"
#include "client/connection.h"
#include "core/volume/volume.h"

namespace bccskel::client {

// Skeletons from a server.
//
//   bccskel::client::SkeletonizeClient client(bccskel::client::Connect("127.0.0.1:50051"));
//   absl::StatusOr<bccskel::SkeletonizeResult> result = client.Skeletonize(volume, {});
//
// Threads: safe; calls run concurrently.
class SkeletonizeClient {
 public:
  explicit SkeletonizeClient(std::shared_ptr<Connection> connection)
      : connection_(std::move(connection)) {}

  // The same result as core/pipeline on this machine; `thin` only if the options request it.
  // Errors: see Connection::Skeletonize().
  absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object, const CallOptions& options);

  // The skeleton of every label of a segmented image, as from core/labels on this machine (without
  // `thin`). Passes each to `consume` as soon as it arrives.
  // Errors: INVALID_ARGUMENT (volume); see Connection::SkeletonizeLabels().
  absl::StatusOr<LabelsReport> SkeletonizeLabels(const LabelVolume& volume,
                                                 const LabelsCallOptions& options,
                                                 const LabelConsumer& consume);

 private:
  std::shared_ptr<Connection> connection_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_SKELETONIZE_CLIENT_H_
