#include "core/labels/label_collector.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

void Include(VoxelBox& box, const VoxelRun& run) {
  box.low = {std::min(box.low[0], run.begin), std::min(box.low[1], run.y),
             std::min(box.low[2], run.z)};
  box.high = {std::max(box.high[0], run.end), std::max(box.high[1], run.y + 1),
              std::max(box.high[2], run.z + 1)};
}

// Of the equal labels from x on. Compares several at a time, since most are the background's.
size_t EndOfRun(std::span<const uint64_t> labels, size_t x) {
  constexpr size_t kAtOnce = 8;
  const uint64_t label = labels[x];
  for (; x + kAtOnce <= labels.size(); x += kAtOnce) {
    uint64_t differences = 0;
    for (size_t n = 0; n < kAtOnce; ++n) differences |= labels[x + n] ^ label;
    if (differences != 0) break;
  }
  while (x < labels.size() && labels[x] == label) ++x;
  return x;
}

}  // namespace

absl::StatusOr<LabelCollector> LabelCollector::Create(const MaskGrid& grid,
                                                      const LabelFilter& filter) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskGrid(grid));
  if (std::ranges::count(filter.labels, uint64_t{0}) > 0) {
    return absl::InvalidArgumentError("label 0 is the background: it cannot be selected");
  }
  return LabelCollector(grid, filter);
}

LabelCollector::LabelCollector(const MaskGrid& grid, const LabelFilter& filter)
    : grid_(grid), filter_(filter) {
  objects_.reserve(filter.labels.size());
  for (uint64_t label : filter.labels) {
    if (places_.try_emplace(label, objects_.size()).second) objects_.push_back({.label = label});
  }
}

absl::Status LabelCollector::AddSlice(std::span<const uint64_t> labels,
                                      const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckLabelSlice(grid_, next_z_, labels));
  const auto nx = static_cast<size_t>(grid_.nx);
  for (int32_t y = 0; y < grid_.ny; ++y) {
    AddRow(labels.subspan(static_cast<size_t>(y) * nx, nx), y);
    BCCSKEL_RETURN_IF_ERROR(CheckLimits());
  }
  ++next_z_;
  return context.StopStatus();
}

absl::Status LabelCollector::AddMaskSlice(std::span<const uint64_t> words,
                                          const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckMaskSlice(grid_, next_z_, words));
  rows_.SetDense(grid_, words);
  for (size_t n = 0; n < rows_.size(); ++n) {
    ForEachRun(rows_[n], [&](int32_t begin, int32_t end) {
      AddRun(1, {next_z_, rows_.y(n), begin, end});
    });
    BCCSKEL_RETURN_IF_ERROR(CheckLimits());
  }
  ++next_z_;
  return context.StopStatus();
}

absl::Status LabelCollector::CheckLimits() const {
  if (runs_ > filter_.max_runs) {
    return absl::ResourceExhaustedError(absl::StrFormat(
        "the image has more runs of labeled voxels than the limit of %d", filter_.max_runs));
  }
  if (filter_.labels.empty() && objects_.size() > filter_.max_labels) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("the image has more labels than the limit of %d", filter_.max_labels));
  }
  return absl::OkStatus();
}

void LabelCollector::AddRow(std::span<const uint64_t> labels, int32_t y) {
  for (size_t x = 0; x < labels.size();) {
    const size_t begin = x;
    const uint64_t label = labels[x];
    x = EndOfRun(labels, x);
    if (label == 0) continue;
    AddRun(label, {next_z_, y, static_cast<int32_t>(begin), static_cast<int32_t>(x)});
  }
}

void LabelCollector::AddRun(uint64_t label, const VoxelRun& run) {
  LabeledObject* object = label == last_label_ ? last_object_ : Find(label);
  if (object == nullptr) return;
  if (object->runs.empty()) {
    object->box = {{run.begin, run.y, run.z}, {run.end, run.y + 1, run.z + 1}};
  }
  Include(object->box, run);
  object->voxels += static_cast<uint64_t>(run.end - run.begin);
  object->runs.push_back(run);
  ++runs_;
}

LabeledObject* LabelCollector::Find(uint64_t label) {
  last_label_ = label;
  last_object_ = nullptr;
  if (filter_.labels.empty()) {
    const auto [at, fresh] = places_.try_emplace(label, objects_.size());
    if (fresh) objects_.push_back({.label = label});
    return last_object_ = &objects_[at->second];
  }
  const auto at = places_.find(label);
  return last_object_ = at == places_.end() ? nullptr : &objects_[at->second];
}

absl::StatusOr<LabeledObjects> LabelCollector::Finish() && {
  if (next_z_ != grid_.nz) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the image ends after %d of %d slices", next_z_, grid_.nz));
  }
  const uint64_t fewest = std::max(filter_.min_voxels, uint64_t{1});
  std::erase_if(objects_, [&](const LabeledObject& object) { return object.voxels < fewest; });
  std::ranges::sort(objects_, {}, &LabeledObject::label);
  return LabeledObjects{grid_, std::move(objects_)};
}

}  // namespace bccskel
