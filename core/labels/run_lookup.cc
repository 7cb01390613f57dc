#include "core/labels/run_lookup.h"

#include <algorithm>
#include <tuple>

#include "core/exec/union_find.h"

namespace bccskel {
namespace {

// Joins the runs of two rows that lie within `step` of each other in x.
void LinkRows(std::span<const VoxelRun> runs, RunLookup::Range a, RunLookup::Range b, int32_t step,
              UnionFind<size_t>& sets) {
  for (RunIndex i = a.begin, j = b.begin; i < a.end && j < b.end;) {
    if (runs[i].begin < runs[j].end + step && runs[j].begin < runs[i].end + step) sets.Unite(i, j);
    runs[i].end < runs[j].end ? ++i : ++j;
  }
}

RunIndex EndOfRow(std::span<const VoxelRun> runs, RunIndex begin) {
  RunIndex end = begin;
  while (end < runs.size() && runs[end].z == runs[begin].z && runs[end].y == runs[begin].y) ++end;
  return end;
}

}  // namespace

RunLookup::Range RunLookup::Row(int32_t z, int32_t y) const {
  const auto first = std::ranges::lower_bound(runs_, VoxelRun{z, y, 0, 0});
  const auto begin = static_cast<RunIndex>(first - runs_.begin());
  if (first == runs_.end() || first->z != z || first->y != y) return {begin, begin};
  return {begin, EndOfRow(runs_, begin)};
}

std::optional<RunIndex> RunLookup::Find(const std::array<int32_t, 3>& voxel) const {
  const auto [x, y, z] = voxel;
  // The last run that begins at or before the voxel.
  const auto next = std::ranges::upper_bound(
      runs_, VoxelRun{z, y, x, 0}, [](const VoxelRun& a, const VoxelRun& b) {
        return std::tie(a.z, a.y, a.begin) < std::tie(b.z, b.y, b.begin);
      });
  if (next == runs_.begin()) return std::nullopt;
  const VoxelRun& run = *(next - 1);
  if (run.z != z || run.y != y || x >= run.end) return std::nullopt;
  return static_cast<RunIndex>(next - 1 - runs_.begin());
}

std::vector<RunIndex> ComponentsOfRuns(std::span<const VoxelRun> runs, MaskAdjacency adjacency) {
  const int32_t step = adjacency == MaskAdjacency::k26 ? 1 : 0;
  const RunLookup lookup(runs);
  UnionFind<size_t> sets(runs.size());
  for (RunIndex begin = 0; begin < runs.size();) {
    const RunLookup::Range row = {begin, EndOfRow(runs, begin)};
    const int32_t z = runs[begin].z, y = runs[begin].y;
    LinkRows(runs, row, lookup.Row(z, y - 1), step, sets);
    for (int32_t near = y - step; near <= y + step; ++near) {
      LinkRows(runs, row, lookup.Row(z - 1, near), step, sets);
    }
    begin = row.end;
  }
  std::vector<RunIndex> components(runs.size());
  for (RunIndex n = 0; n < runs.size(); ++n) components[n] = sets.Find(n);
  return components;
}

}  // namespace bccskel
