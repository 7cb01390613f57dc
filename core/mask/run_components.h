#ifndef BCCSKEL_CORE_MASK_RUN_COMPONENTS_H_
#define BCCSKEL_CORE_MASK_RUN_COMPONENTS_H_

#include <cstdint>
#include <span>

#include "core/exec/disjoint_sets.h"
#include "core/mask/phase_runs.h"

namespace bccskel {

// Counts the components of one phase of a mask, slice by slice: every run is a set of its own, runs
// that touch are joined, and each successful join reduces the number of components by one. Runs of
// the background that reach the border belong to the outside, set 0, which is not counted.
// Memory: the runs of two slices; sets are renumbered after each.
class RunComponents {
 public:
  RunComponents(MaskPhase phase, Contact contact, int32_t ny)
      : phase_(phase), contact_(contact), before_(ny), runs_(ny) {}

  // Adds the next slice: rows in order of y, and the runs of each in order. Omitted rows have no
  // object voxels.
  void AddRow(int32_t y);
  void AddObjectRun(int32_t begin, int32_t end);
  void EndRow();
  void EndSlice();

  // Needs: the empty slices at the end have been added (one is enough).
  int64_t count() const { return count_; }

 private:
  void AddNewSet(int32_t begin, int32_t end);
  void LinkRow(int32_t y);
  void LinkToOutside(int32_t y, PhaseRuns& slice, const PhaseRuns& other);
  void LinkRows(std::span<PhaseRun> a, std::span<PhaseRun> b);
  void Join(uint32_t a, uint32_t b);
  void Renumber();

  // The largest difference in y to a touching row of the previous slice.
  int32_t reach() const { return contact_ == Contact::kCorner ? 1 : 0; }

  const MaskPhase phase_;
  const Contact contact_;
  PhaseRuns before_;  // the previous slice
  PhaseRuns runs_;    // this slice
  int32_t last_end_ = 0;
  DisjointSets sets_{1};
  int64_t count_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_RUN_COMPONENTS_H_
