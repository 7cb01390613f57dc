#ifndef BCCSKEL_SERVER_JOBS_LABEL_INTAKE_H_
#define BCCSKEL_SERVER_JOBS_LABEL_INTAKE_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/io/encoded_body.h"
#include "core/labels/label_collector.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/upload_digest.h"

namespace bccskel::server {

struct CollectedLabels {
  LabeledObjects objects;
  uint64_t skipped = 0;  // too small
  uint64_t absent = 0;   // wanted, but without a voxel
};

// Takes in the bytes of a declared volume of labels, a slice at a time; keeps the runs of the
// labels that are wanted. Threads: one at a time.
class LabelIntake {
 public:
  // Needs: `request` outlives the intake.
  explicit LabelIntake(const LabelsRequest& request);

  // Errors: INVALID_ARGUMENT for bytes that are malformed, too many or not what was declared;
  //         CANCELLED, DEADLINE_EXCEEDED.
  absl::Status Append(std::string_view bytes, const exec::Context& context);
  // Called once. Errors: as Append(); INVALID_ARGUMENT when bytes are missing and for another
  // digest than `expected`.
  absl::StatusOr<CollectedLabels> Finish(const std::optional<Sha256Digest>& expected,
                                         const exec::Context& context);

 private:
  absl::Status Start();
  absl::Status AddBytes(std::span<const std::byte> bytes, const exec::Context& context);
  absl::Status AddSlice(const exec::Context& context);
  absl::Status CheckPromises(const LabeledObjects& objects) const;

  const LabelsRequest& request_;
  const LabelVolumeHeader& header_;
  UploadDigest digest_;
  std::optional<BodyReader> body_;  // what takes memory is made with the first bytes
  std::optional<LabelCollector> collector_;
  std::vector<std::byte> slice_;  // the next one, as far as it is here
  size_t filled_bytes_ = 0;
  std::vector<uint64_t> labels_;
  uint64_t received_bytes_ = 0;  // after decompression
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_LABEL_INTAKE_H_
