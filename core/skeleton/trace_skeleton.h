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

// Memory that TraceSkeleton() takes for each point of a skeleton, its graph included as long as
// that has no more than kEdgePointsPerPoint points on edges for each. What was seen: 330 bytes for
// isolated points, 400 for nets.
inline constexpr uint64_t kTraceBytesPerPoint = 512;
inline constexpr size_t kEdgePointsPerPoint = 4;
// For each point on edges beyond that, with the copies that merging junctions makes. Paths to the
// middle of large clusters have many.
inline constexpr uint64_t kTraceBytesPerEdgePoint = 256;

// TraceSkeleton() within a budget. Reserves what points on edges need beyond kTraceBytesPerPoint,
// which the caller has reserved.
// Errors: as TraceSkeleton(); the budget's.
absl::StatusOr<SkeletonGraph> TraceSkeleton(const ThinSkeleton& skeleton,
                                            exec::MemoryBudget& memory,
                                            const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_TRACE_SKELETON_H_
