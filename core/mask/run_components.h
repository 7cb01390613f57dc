#ifndef BCCSKEL_CORE_MASK_RUN_COMPONENTS_H_
#define BCCSKEL_CORE_MASK_RUN_COMPONENTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/certificate/brick_components.h"
#include "core/exec/union_find.h"

namespace bccskel {

// Whether voxels that share a corner touch, or only those that share a face.
enum class Contact : uint8_t { kFace, kCorner };

// Voxels [begin, end) of a row, all of one phase.
struct PhaseRun {
  int32_t begin = 0;
  int32_t end = 0;
  uint32_t set = 0;
};

// The runs of one phase in one slice, by row. Rows without object voxels are not stored: for the
// object they are empty, for the background one run of the outside.
class PhaseRuns {
 public:
  explicit PhaseRuns(int32_t ny) : row_at_(static_cast<size_t>(ny) + 2, kAbsent) {}

  void Clear();
  // Starts row y. Needs: y increases.
  void AddRow(int32_t y);
  void AddRun(PhaseRun run) { runs_.push_back(run); }

  bool Has(int32_t y) const { return row_at_[static_cast<size_t>(y + 1)] != kAbsent; }
  // Needs: -1 <= y <= ny and Has(y).
  std::span<PhaseRun> Row(int32_t y);
  std::span<const int32_t> rows() const { return rows_; }
  std::span<PhaseRun> runs() { return runs_; }

 private:
  static constexpr uint32_t kAbsent = ~uint32_t{0};
  std::vector<uint32_t> row_at_;  // y + 1 -> position in rows_
  std::vector<int32_t> rows_;     // y
  std::vector<size_t> begins_;
  std::vector<PhaseRun> runs_;
};

// Counts the components of one phase of a mask, slice by slice: every run is a set of its own, runs
// that touch are joined, and each successful join reduces the number of components by one. Runs of
// the background that reach the border belong to the outside, set 0, which is not counted.
// Memory: the runs of two slices; sets are renumbered after each.
class RunComponents {
 public:
  RunComponents(Phase phase, Contact contact, int32_t ny)
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

  const Phase phase_;
  const Contact contact_;
  PhaseRuns before_;  // the previous slice
  PhaseRuns runs_;    // this slice
  int32_t last_end_ = 0;
  UnionFind<uint32_t> sets_{1};
  int64_t count_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_RUN_COMPONENTS_H_
