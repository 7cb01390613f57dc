#include "core/mask/run_components.h"

#include <limits>
#include <utility>

namespace bccskel {
namespace {

constexpr uint32_t kOutside = 0;
// Half the range, so that ends plus a step can be compared.
constexpr int32_t kFar = std::numeric_limits<int32_t>::max() / 2;

}  // namespace

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

void RunComponents::AddRow(int32_t y) {
  runs_.AddRow(y);
  last_end_ = -kFar;
}

void RunComponents::AddNewSet(int32_t begin, int32_t end) {
  runs_.AddRun({begin, end, sets_.Add()});
  ++count_;
}

void RunComponents::AddObjectRun(int32_t begin, int32_t end) {
  if (phase_ == Phase::kObject) {
    AddNewSet(begin, end);
  } else if (last_end_ == -kFar) {
    runs_.AddRun({-kFar, begin, kOutside});
  } else {
    AddNewSet(last_end_, begin);
  }
  last_end_ = end;
}

void RunComponents::EndRow() {
  if (phase_ == Phase::kBackground) runs_.AddRun({last_end_, kFar, kOutside});
}

void RunComponents::EndSlice() {
  for (int32_t y : runs_.rows()) LinkRow(y);
  if (phase_ == Phase::kBackground) {
    for (int32_t y : runs_.rows()) LinkToOutside(y, runs_, before_);
    for (int32_t y : before_.rows()) LinkToOutside(y, before_, runs_);
  }
  Renumber();
  std::swap(before_, runs_);
  runs_.Clear();
}

void RunComponents::LinkRow(int32_t y) {
  const std::span<PhaseRun> row = runs_.Row(y);
  if (runs_.Has(y - 1)) LinkRows(row, runs_.Row(y - 1));
  for (int32_t other = y - reach(); other <= y + reach(); ++other) {
    if (before_.Has(other)) LinkRows(row, before_.Row(other));
  }
}

// A row without object voxels next to this one, in its own or the other slice, is outside and
// touches every run.
void RunComponents::LinkToOutside(int32_t y, PhaseRuns& slice, const PhaseRuns& other) {
  bool open = !slice.Has(y - 1) || !slice.Has(y + 1);
  for (int32_t near = y - reach(); near <= y + reach(); ++near) open |= !other.Has(near);
  if (!open) return;
  for (const PhaseRun& run : slice.Row(y)) Join(run.set, kOutside);
}

void RunComponents::LinkRows(std::span<PhaseRun> a, std::span<PhaseRun> b) {
  const int32_t step = reach();
  for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i].begin < b[j].end + step && b[j].begin < a[i].end + step) Join(a[i].set, b[j].set);
    // Runs of a row are separated by gaps, so the run after the one with the nearer end does not
    // reach the other.
    a[i].end < b[j].end ? ++i : ++j;
  }
}

// A set is found by its smallest member, so the outside stays set 0.
void RunComponents::Join(uint32_t a, uint32_t b) {
  if (sets_.Unite(a, b)) --count_;
}

void RunComponents::Renumber() {
  constexpr uint32_t kNone = ~uint32_t{0};
  std::vector<uint32_t> number(sets_.size(), kNone);
  number[kOutside] = kOutside;
  uint32_t next = kOutside + 1;
  for (PhaseRun& run : runs_.runs()) {
    uint32_t& fresh = number[sets_.Find(run.set)];
    if (fresh == kNone) fresh = next++;
    run.set = fresh;
  }
  sets_.Reset(next);
}

}  // namespace bccskel
