#ifndef BCCSKEL_CLIENT_CALL_OPTIONS_H_
#define BCCSKEL_CLIENT_CALL_OPTIONS_H_

#include <chrono>
#include <functional>
#include <stop_token>

#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::client {

// Whether the thinned volume comes back beside the graph.
enum class ThinVolume { kOmit, kReturn };

// Everything about one call but the volume. The defaults suit a program without a user waiting.
struct CallOptions {
  SkeletonizeOptions skeletonize = {};
  // Threads wanted on the server; 0 leaves the number to it. The result is the same for any.
  int threads = 0;
  ThinVolume thin_volume = ThinVolume::kOmit;
  // For all attempts together.
  std::chrono::milliseconds timeout = std::chrono::hours(1);
  // Cancels the call and the job on the server.
  std::stop_token stop = {};
  // Called between reads on the calling thread; after a retry the shells begin anew.
  std::function<void(const exec::ShellProgress&)> on_shell = {};
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_CALL_OPTIONS_H_
