#ifndef BCCSKEL_CLIENT_CLI_SHELL_COLLECTOR_H_
#define BCCSKEL_CLIENT_CLI_SHELL_COLLECTOR_H_

#include <cstdint>
#include <map>
#include <span>

#include "client/view/display_surface.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// Keeps the points that go with each shell while a job runs, here or on a server.
class ShellCollector {
 public:
  // `object` must outlive the collector.
  explicit ShellCollector(const Volume& object) : object_(object) {}

  void Add(int32_t shell, std::span<const LatticePoint> points) {
    // A call that is tried again tells all shells again.
    if (shell < last_) shells_.clear();
    last_ = shell;
    const auto [at, is_new] =
        shells_.try_emplace(shell, VolumeBuilder(object_.extent(), object_.placement()));
    for (LatticePoint p : points) at->second.Add(p);
  }

  view::PeeledShells Take() && {
    view::PeeledShells shells;
    for (auto& [shell, builder] : shells_) {
      if (auto points = std::move(builder).Build(); points.ok()) shells[shell] = *std::move(points);
    }
    return shells;
  }

 private:
  const Volume& object_;
  int32_t last_ = 0;
  std::map<int32_t, VolumeBuilder> shells_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_SHELL_COLLECTOR_H_
