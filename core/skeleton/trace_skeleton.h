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

// Memory that TraceSkeleton() needs for each point of a skeleton, including its graph as long as
// that has at most kEdgePointsPerPoint points on edges for each. Measured: 330 bytes for isolated
// points, 400 for nets.
inline constexpr uint64_t kTraceBytesPerPoint = 512;
inline constexpr size_t kEdgePointsPerPoint = 4;
// Memory for each further point on edges, including the copies that merging junctions makes. Paths
// to the middle of large clusters have many.
inline constexpr uint64_t kTraceBytesPerEdgePoint = 256;

// TraceSkeleton() within a budget. Reserves the memory of points on edges beyond
// kTraceBytesPerPoint, which the caller has reserved.
// Errors: as TraceSkeleton(); the budget's.
absl::StatusOr<SkeletonGraph> TraceSkeleton(const ThinSkeleton& skeleton,
                                            exec::MemoryBudget& memory,
                                            const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_TRACE_SKELETON_H_
