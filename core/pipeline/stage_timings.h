#ifndef BCCSKEL_CORE_PIPELINE_STAGE_TIMINGS_H_
#define BCCSKEL_CORE_PIPELINE_STAGE_TIMINGS_H_

#include <array>
#include <chrono>

namespace bccskel {

// Wall time of each stage of the pipeline.
struct StageTimings {
  using Duration = std::chrono::nanoseconds;
  Duration preparing{0};
  Duration distance{0};
  Duration shells{0};    // 0 if they are made while distances are measured
  Duration thinning{0};  // until stable
  Duration cleanup{0};
  Duration pruning{0};  // radii, branches and tips
  Duration certificate{0};
  Duration graph{0};
  Duration total{0};

  friend bool operator==(const StageTimings&, const StageTimings&) = default;
};

struct Stage {
  const char* name;
  StageTimings::Duration StageTimings::*time;
};

// In the order in which they run. All code that shows or sends times uses this list.
inline constexpr std::array<Stage, 8> kStages = {{
    {"preparing", &StageTimings::preparing},
    {"distance", &StageTimings::distance},
    {"shells", &StageTimings::shells},
    {"thinning", &StageTimings::thinning},
    {"cleanup", &StageTimings::cleanup},
    {"pruning", &StageTimings::pruning},
    {"certificate", &StageTimings::certificate},
    {"graph", &StageTimings::graph},
}};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_STAGE_TIMINGS_H_
