#ifndef BCCSKEL_CORE_MASK_PHASE_RUNS_H_
#define BCCSKEL_CORE_MASK_PHASE_RUNS_H_

#include <cstdint>
#include <span>
#include <vector>

namespace bccskel {

// The voxels of the object or of the background.
enum class MaskPhase : uint8_t { kObject, kBackground };
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

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_PHASE_RUNS_H_
