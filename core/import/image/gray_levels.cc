#include "core/import/image/gray_levels.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <type_traits>
#include <variant>

namespace bccskel {
namespace {

// Of pairs or values: fewer tell nothing.
constexpr size_t kFewest = 256;

// Needs: sorted values.
double OtsuThreshold(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const auto count = static_cast<double>(values.size());
  double below = 0, best = 0, threshold = values.front();
  for (size_t n = 1; n < values.size(); ++n) {
    below += values[n - 1];
    if (values[n] == values[n - 1]) continue;
    const auto low = static_cast<double>(n), high = count - low;
    const double between = below / low - (sum - below) / high;
    const double variance = low * high * between * between;
    if (variance <= best) continue;
    best = variance;
    threshold = (values[n - 1] + values[n]) / 2;
  }
  return threshold;
}

}  // namespace

GrayLevels::GrayLevels(const ImageSize& size) {
  constexpr int64_t kVoxels = 250'000;
  step_ = std::max<int64_t>(1, int64_t{size.ny} * size.nz * size.nx / kVoxels);
}

template <typename T>
void GrayLevels::AddRow(std::span<const T> row) {
  T before = 0;
  for (const T value : row) {
    if (value == 0) {
      ++zeros_;
    } else {
      if (!std::isfinite(static_cast<double>(value))) continue;
      values_.push_back(static_cast<double>(value));
      if (before != 0) {
        ++pairs_;
        if (value != before) ++unequal_;
      }
    }
    before = value;
  }
}

template <typename T>
void GrayLevels::AddRuns(std::span<const T> row) {
  for (auto begin = row.begin(); begin != row.end();) {
    const auto end = std::find_if(begin, row.end(), [&](const T value) { return value != *begin; });
    if (*begin > 0) {
      Neighbors& neighbors = labels_[static_cast<uint64_t>(*begin)];
      neighbors.equal += end - begin - 1;
      if (begin != row.begin() && *(begin - 1) != 0) ++neighbors.others;
      if (end != row.end() && *end != 0) ++neighbors.others;
    }
    begin = end;
  }
}

void GrayLevels::Add(const ImageSlice& slice) {
  const auto nx = static_cast<size_t>(slice.nx);
  std::visit(
      [&]<typename T>(std::span<const T> values) {
        for (size_t y = 0; y < static_cast<size_t>(slice.ny); ++y) {
          if (next_row_++ % step_ != 0) continue;
          AddRow(values.subspan(y * nx, nx));
          if constexpr (std::is_integral_v<T>) AddRuns(values.subspan(y * nx, nx));
        }
      },
      slice.values);
}

std::optional<double> GrayLevels::Threshold() const {
  if (pairs_ < kFewest || 2 * unequal_ <= pairs_) return std::nullopt;
  std::vector<double> values = values_;
  values.insert(values.end(), zeros_, 0);
  std::ranges::sort(values);
  return OtsuThreshold(values);
}

bool GrayLevels::HasOneValue() const {
  return !values_.empty() &&
         std::ranges::adjacent_find(values_, std::not_equal_to()) == values_.end();
}

bool GrayLevels::HasSeveralLabels() const {
  const auto is_label = [](const auto& entry) { return entry.second.equal >= entry.second.others; };
  return std::ranges::count_if(labels_, is_label) > 1;
}

bool GrayLevels::HasBothSigns() const {
  const auto is_below = [](double value) { return value < 0; };
  const auto below = static_cast<size_t>(std::ranges::count_if(values_, is_below));
  const size_t all = values_.size() + zeros_;
  return all >= kFewest && below > 0 && below < values_.size() && 100 * zeros_ < all;
}

}  // namespace bccskel
