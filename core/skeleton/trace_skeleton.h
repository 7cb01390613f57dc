#ifndef BCCSKEL_CORE_SKELETON_TRACE_SKELETON_H_
#define BCCSKEL_CORE_SKELETON_TRACE_SKELETON_H_

#include <cstddef>
#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/thin_skeleton.h"

namespace bccskel {

// Points on edges, for each point of a skeleton, whose memory the caller has reserved.
inline constexpr size_t kEdgePointsPerPoint = 4;
// Memory for each further point on edges, including the copies that merging junctions makes. Paths
// to the middle of large clusters have many.
inline constexpr uint64_t kTraceBytesPerEdgePoint = 256;

// TraceSkeleton() within a budget. Reserves the memory of points on edges beyond
// kEdgePointsPerPoint; the caller has reserved that of the rest.
// Errors: as TraceSkeleton(); the budget's.
absl::StatusOr<SkeletonGraph> TraceSkeleton(const ThinSkeleton& skeleton,
                                            exec::MemoryBudget& memory,
                                            const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_TRACE_SKELETON_H_
