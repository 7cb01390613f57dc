#include "core/mask/phase_runs.h"

namespace bccskel {

void PhaseRuns::Clear() {
  for (int32_t y : rows_) row_at_[static_cast<size_t>(y + 1)] = kAbsent;
  rows_.clear();
  begins_.clear();
  runs_.clear();
}

void PhaseRuns::AddRow(int32_t y) {
  row_at_[static_cast<size_t>(y + 1)] = static_cast<uint32_t>(rows_.size());
  rows_.push_back(y);
  begins_.push_back(runs_.size());
}

std::span<PhaseRun> PhaseRuns::Row(int32_t y) {
  const size_t n = row_at_[static_cast<size_t>(y + 1)];
  const size_t end = n + 1 < begins_.size() ? begins_[n + 1] : runs_.size();
  return std::span(runs_).subspan(begins_[n], end - begins_[n]);
}

}  // namespace bccskel
