#ifndef BCCSKEL_CLIENT_CALL_OPTIONS_H_
#define BCCSKEL_CLIENT_CALL_OPTIONS_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/mask/mask_grid.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::client {

// Whether the thinned volume is returned with the graph.
enum class ThinVolume { kOmit, kReturn };

// Times of a call that StageTimings does not cover.
struct CallTimes {
  std::chrono::nanoseconds upload{0};    // from the call's start until all of the volume is sent
  std::chrono::nanoseconds queue{0};     // on the server, before the first stage
  std::chrono::nanoseconds decode{0};    // on the server, mostly while the volume arrives
  std::chrono::nanoseconds download{0};  // from the first chunk of the skeleton to the end
};

// Everything about one call but the volume. The defaults suit a program without a user waiting.
struct CallOptions {
  SkeletonizeOptions skeletonize = {};
  // Threads requested from the server; 0 lets it choose. The result is the same for any number.
  int threads = 0;
  ThinVolume thin_volume = ThinVolume::kOmit;
  // For all attempts together.
  std::chrono::milliseconds timeout = std::chrono::hours(1);
  // Cancels the call and the job on the server.
  std::stop_token stop = {};
  // Called between reads on the calling thread; after a retry the shells start again.
  std::function<void(const exec::ShellProgress&)> on_shell = {};
  // If set, the server streams the points removed with each shell: the shells in order, a large one
  // in several parts; then, as shell `last_shell + 1`, the points removed by clean-up and pruning.
  // No point is left out. Called like on_shell.
  std::function<void(int32_t shell, std::span<const LatticePoint>)> on_shell_points = {};
  // Called when the connection broke after the server had stored the job of this name: the call
  // waits for the server, about two minutes, and goes on where it was.
  std::function<void(const std::string& job)> on_lost = {};
  // Called once, at the end of an attempt that succeeds on one stream.
  std::function<void(const CallTimes&)> on_times = {};
};

// Everything about one call for labels but the volume.
struct LabelsCallOptions {
  SkeletonizeOptions skeletonize = {};
  MaskAdjacency adjacency = MaskAdjacency::k26;
  VoxelPoints points = VoxelPoints::kTwo;
  std::vector<uint64_t> labels = {};  // none: all but 0, the background
  uint64_t min_voxels = 0;            // smaller labels are skipped
  // As in CallOptions.
  int threads = 0;
  std::chrono::milliseconds timeout = std::chrono::hours(1);
  std::stop_token stop = {};
  // Called between reads on the calling thread; after a retry it starts again from 0.
  std::function<void(uint64_t done, uint64_t total)> on_progress = {};
};

// Counts over all labels.
struct LabelsReport {
  uint64_t labels = 0;   // delivered
  uint64_t skipped = 0;  // below min_voxels
  uint64_t absent = 0;   // requested, but without a voxel
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_CALL_OPTIONS_H_
