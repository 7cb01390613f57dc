#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_COMPUTE_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_COMPUTE_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/encoded_labels.h"
#include "client/python/native/array_source.h"
#include "client/skeletonize_client.h"
#include "client/view/result_document.h"
#include "core/import/mesh/triangle_mesh.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::python {

// A skeleton and the input that it was made from.
struct Outcome {
  SkeletonizeResult result;
  std::optional<RootChoice> root;
  std::vector<std::string> warnings;
  uint64_t voxels = 0;                   // of a mask or a label
  std::shared_ptr<const Volume> object;  // none for a label
  std::optional<MaskGrid> grid;          // of a mask or a label
  MaskOptions mask;
  // The voxels of a label that was computed here; the object of a mask implies its voxels.
  std::shared_ptr<const LabeledObject> label;

  // For a result read from JSON: how it was made, and the document.
  std::optional<view::ResultFacts> read;
  std::shared_ptr<const std::string> document;

  // JSON results do not state the number of voxels.
  std::optional<uint64_t> KnownVoxels() const {
    return read.has_value() ? std::nullopt : std::optional(voxels);
  }

  // Needs:  not a result read from JSON.
  // Errors: UNIMPLEMENTED for a label that a server has computed.
  absl::StatusOr<std::shared_ptr<const Volume>> Object() const;
};

// A JSON result. Errors: those of ReadResultDocument() and ResultGraphOf().
absl::StatusOr<Outcome> ReadResult(const std::string& path, const std::stop_token& stop);

using OnProgress = std::function<void(uint64_t done, uint64_t total)>;

// Where and how a skeleton is computed, apart from its options.
struct Run {
  std::shared_ptr<client::SkeletonizeClient> server;  // null: on this machine
  int threads = 0;                                    // 0: all of the machine
  std::chrono::milliseconds timeout = std::chrono::hours(24 * 365);
  std::stop_token stop;
  OnProgress on_progress;  // shells, or labels
};

// Errors: as ConvertImage(), Skeletonize() and CheckRootChoice(); INVALID_ARGUMENT if no voxel has
//         a requested label; INTERNAL if an exact conversion changed the topology, which would be a
//         defect.
absl::StatusOr<Outcome> SkeletonizeMask(const ArraySource& array,
                                        const cli::SkeletonizeArguments& arguments, const Run& run);

// Errors: as Voxelize(), Skeletonize() and CheckRootChoice().
absl::StatusOr<Outcome> SkeletonizeMesh(const TriangleMesh& mesh,
                                        const cli::SkeletonizeArguments& arguments, const Run& run);

// Errors: as Skeletonize() and CheckRootChoice().
absl::StatusOr<Outcome> SkeletonizeVolume(const Volume& object,
                                          const cli::SkeletonizeArguments& arguments,
                                          const Run& run);

using LabelOutcomes = std::map<uint64_t, std::shared_ptr<Outcome>>;

// Errors: as CollectLabels() and SkeletonizeLabels().
absl::StatusOr<LabelOutcomes> SkeletonizeImage(const ArraySource& image,
                                               const cli::LabelsArguments& arguments,
                                               const Run& run);

// Needs: run.server.
// Errors: those of SkeletonizeClient::SkeletonizeLabels(); UNIMPLEMENTED for samplings.
absl::StatusOr<LabelOutcomes> SkeletonizeOnServer(const ArraySource& array,
                                                  const client::LabelVolume& image,
                                                  const cli::LabelsArguments& arguments,
                                                  const Run& run);

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_COMPUTE_H_
