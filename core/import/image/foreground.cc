#include "core/import/image/foreground.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

template <typename T>
struct Interval {
  T low;
  T high;
};

// The values of type T in [low, high]; nothing where there are none.
template <typename T>
std::optional<Interval<T>> IntervalOf(double low, double high) {
  if constexpr (std::is_floating_point_v<T>) {
    Interval<T> result = {static_cast<T>(low), static_cast<T>(high)};
    constexpr T kInfinity = std::numeric_limits<T>::infinity();
    if (result.low < low) result.low = std::nextafter(result.low, kInfinity);
    if (result.high > high) result.high = std::nextafter(result.high, -kInfinity);
    return result.low <= result.high ? std::optional(result) : std::nullopt;
  } else {
    using Limits = std::numeric_limits<T>;
    const double end = std::ldexp(1.0, Limits::digits);  // one behind the largest
    const auto least = static_cast<double>(Limits::min());
    low = std::ceil(low);
    high = std::floor(high);
    if (low > high || low >= end || high < least) return std::nullopt;
    return Interval<T>{low <= least ? Limits::min() : static_cast<T>(low),
                       high >= end ? Limits::max() : static_cast<T>(high)};
  }
}

// The lowest bit of each of 8 bytes, as the bits of one.
uint64_t GatherBits(const uint8_t* flags) {
  uint64_t bytes;
  std::memcpy(&bytes, flags, 8);
  if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
  return (bytes * 0x0102040810204080U) >> 56;
}

constexpr size_t kWordBits = 64;

template <typename T>
bool AreZeros(const T* values) {
  std::array<uint64_t, sizeof(T) * kWordBits / sizeof(uint64_t)> words;
  std::memcpy(words.data(), values, sizeof(words));
  uint64_t any = 0;
  for (uint64_t word : words) any |= word;
  return any == 0;
}

// Flags first and bits after: the compiler turns the first loop into vector instructions, best
// where it knows their number. Most of an image is empty mostly.
template <typename T, typename Test>
uint64_t WordOf(const T* values, size_t count, const Test& test) {
  if (count == kWordBits && values[0] == T{0} && AreZeros(values))
    return test(T{0}) ? ~uint64_t{0} : 0;
  std::array<uint8_t, kWordBits> flags;
  if (count == flags.size()) {
    for (size_t n = 0; n < flags.size(); ++n) flags[n] = test(values[n]) ? 1 : 0;
  } else {
    flags = {};
    for (size_t n = 0; n < count; ++n) flags[n] = test(values[n]) ? 1 : 0;
  }
  uint64_t word = 0;
  for (size_t n = 0; n < 8; ++n) word |= GatherBits(flags.data() + 8 * n) << (8 * n);
  return word;
}

template <typename T, typename Test>
void WriteWords(const ImageSlice& slice, std::span<const T> values, const Test& test,
                std::span<uint64_t> words) {
  const auto nx = static_cast<size_t>(slice.nx);
  const size_t row_words = WordsPerRow(slice.nx);
  for (size_t y = 0; y < static_cast<size_t>(slice.ny); ++y) {
    const T* row = values.data() + y * nx;
    for (size_t n = 0; n < row_words; ++n) {
      words[y * row_words + n] = WordOf(row + 64 * n, std::min<size_t>(64, nx - 64 * n), test);
    }
  }
}

template <typename T>
bool IsNumber(T value) {
  return value == value;
}

template <typename T>
void WriteRange(const ImageSlice& slice, std::span<const T> values, const ForegroundRule& rule,
                std::span<uint64_t> words) {
  const std::optional<Interval<T>> interval = IntervalOf<T>(rule.low(), rule.high());
  if (!interval.has_value()) {
    const bool all = rule.inverted();
    return WriteWords(
        slice, values, [all](T v) { return all && IsNumber(v); }, words);
  }
  const T low = interval->low;
  const T high = interval->high;
  if (rule.inverted()) {
    WriteWords(
        slice, values, [=](T v) { return (v < low) | (v > high); }, words);
  } else {
    WriteWords(
        slice, values, [=](T v) { return (v >= low) & (v <= high); }, words);
  }
}

// The labels that a value of type T can have.
template <typename T>
std::vector<T> LabelsOf(const ForegroundRule& rule) {
  std::vector<T> labels;
  for (const uint64_t label : rule.labels()) {
    if constexpr (std::is_floating_point_v<T>) {
      const T value = static_cast<T>(label);
      constexpr T kEnd = static_cast<T>(18446744073709551616.0);
      if (value < kEnd && static_cast<uint64_t>(value) == label) labels.push_back(value);
    } else if (std::in_range<T>(label)) {
      labels.push_back(static_cast<T>(label));
    }
  }
  return labels;
}

// Neighbors mostly have one label, so the last answer mostly is the next one.
template <typename T>
class LabelTest {
 public:
  LabelTest(std::span<const T> labels, bool inverted) : labels_(labels), inverted_(inverted) {
    answer_ = Answer(last_);
  }

  bool operator()(T value) const {
    if (value != last_) {
      last_ = value;
      answer_ = Answer(value);
    }
    return answer_;
  }

 private:
  bool Answer(T value) const {
    return IsNumber(value) && std::ranges::binary_search(labels_, value) != inverted_;
  }

  std::span<const T> labels_;
  bool inverted_;
  mutable T last_ = 0;
  mutable bool answer_ = false;
};

template <typename T>
void WriteLabels(const ImageSlice& slice, std::span<const T> values, const ForegroundRule& rule,
                 std::span<uint64_t> words) {
  const std::vector<T> labels = LabelsOf<T>(rule);
  if (labels.size() != 1) {
    return WriteWords(slice, values, LabelTest<T>(labels, rule.inverted()), words);
  }
  const T label = labels.front();
  if (rule.inverted()) {
    WriteWords(
        slice, values, [=](T v) { return (v < label) | (v > label); }, words);
  } else {
    WriteWords(
        slice, values, [=](T v) { return v == label; }, words);
  }
}

template <typename T>
bool IsLabel(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return value >= 0 && value < static_cast<T>(18446744073709551616.0) &&
           value == std::floor(value);
  } else {
    return value >= 0;
  }
}

template <typename T>
absl::Status WriteLabelValues(const ImageSlice& slice, std::span<const T> values,
                              std::span<uint64_t> labels) {
  for (size_t n = 0; n < values.size(); ++n) {
    const T value = values[n];
    if (IsLabel(value)) {
      // NOLINTNEXTLINE(bugprone-signed-char-misuse): it is not negative
      labels[n] = static_cast<uint64_t>(value);
    } else if (!IsNumber(value)) {
      labels[n] = 0;
    } else {
      const size_t nx = static_cast<size_t>(slice.nx);
      return absl::InvalidArgumentError(
          absl::StrFormat("voxel (%d, %d, %d) is %g; labels are whole numbers from 0 on", n % nx,
                          n / nx, slice.z, static_cast<double>(value)));
    }
  }
  return absl::OkStatus();
}

}  // namespace

ForegroundRule ForegroundRule::NonZero() { return ForegroundRule().Inverted(); }

absl::StatusOr<ForegroundRule> ForegroundRule::Labels(std::vector<uint64_t> labels) {
  if (labels.empty()) return absl::InvalidArgumentError("a list of labels needs at least one");
  std::ranges::sort(labels);
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  ForegroundRule rule;
  rule.labels_ = std::move(labels);
  return rule;
}

absl::StatusOr<ForegroundRule> ForegroundRule::Range(double low, double high) {
  if (!(low <= high)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the range from %g to %g holds no number", low, high));
  }
  ForegroundRule rule;
  rule.low_ = low;
  rule.high_ = high;
  return rule;
}

absl::StatusOr<ForegroundRule> ForegroundRule::From(double threshold) {
  return Range(threshold, kOpen);
}

absl::StatusOr<ForegroundRule> ForegroundRule::Below(double threshold) {
  return Range(-kOpen, std::nextafter(threshold, -kOpen));
}

ForegroundRule ForegroundRule::Inverted() const {
  ForegroundRule rule = *this;
  rule.inverted_ = !inverted_;
  return rule;
}

void ForegroundSlice(const ImageSlice& slice, const ForegroundRule& rule,
                     std::span<uint64_t> words) {
  std::visit(
      [&](const auto values) {
        if (rule.labels().empty()) {
          WriteRange(slice, values, rule, words);
        } else {
          WriteLabels(slice, values, rule, words);
        }
      },
      slice.values);
}

uint64_t CountNotNumbers(const ImageSlice& slice) {
  return std::visit(
      []<typename T>(std::span<const T> values) -> uint64_t {
        if constexpr (!std::is_floating_point_v<T>) return 0;
        return static_cast<uint64_t>(
            std::ranges::count_if(values, [](T value) { return !IsNumber(value); }));
      },
      slice.values);
}

absl::Status LabelSlice(const ImageSlice& slice, std::span<uint64_t> labels) {
  return std::visit([&](const auto values) { return WriteLabelValues(slice, values, labels); },
                    slice.values);
}

}  // namespace bccskel
