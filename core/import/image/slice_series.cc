#include "core/import/image/slice_series.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"

namespace bccskel {
namespace {

using Open = std::function<absl::StatusOr<std::unique_ptr<ImageSource>>(const std::string& name)>;

bool IsDigit(char c) { return absl::ascii_isdigit(static_cast<unsigned char>(c)); }

bool IsSliceName(const std::string& name) {
  return !name.starts_with('.') && (LowerCase(name).ends_with(".png") || IsTiffName(name));
}

// What all names begin with and end with; the number that counts them is between.
struct NamePattern {
  size_t before = 0;
  size_t behind = 0;
};

// Needs: at least two names, sorted.
NamePattern PatternOf(const std::vector<std::string>& names) {
  const std::string& first = names.front();
  const auto agreeing = [&first](const std::string& name) {
    const auto [end, other] = std::ranges::mismatch(first, name);
    return static_cast<size_t>(end - first.begin());
  };
  NamePattern pattern = {.before = agreeing(names.back()), .behind = first.size()};
  for (const std::string& name : names) {
    const auto end = std::mismatch(first.rbegin(), first.rend(), name.rbegin(), name.rend()).first;
    pattern.behind = std::min(pattern.behind, static_cast<size_t>(end - first.rbegin()));
  }
  while (pattern.before > 0 && IsDigit(first[pattern.before - 1])) --pattern.before;
  while (pattern.behind > 0 && IsDigit(first[first.size() - pattern.behind])) --pattern.behind;
  return pattern;
}

std::optional<uint64_t> NumberIn(const std::string& name, const NamePattern& pattern) {
  if (pattern.before + pattern.behind >= name.size()) return std::nullopt;
  const std::string_view digits =
      std::string_view(name).substr(pattern.before, name.size() - pattern.before - pattern.behind);
  if (!std::ranges::all_of(digits, IsDigit)) return std::nullopt;
  return ParseNumber<uint64_t>(digits);
}

using Numbered = std::vector<std::pair<uint64_t, std::string>>;

absl::Status CheckSteps(const Numbered& slices) {
  for (size_t n = 1; n < slices.size(); ++n) {
    const auto& [before, name_before] = slices[n - 1];
    const auto& [number, name] = slices[n];
    if (number == before) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "'%s' and '%s' have the same number; each slice must have its own", name_before, name));
    }
    if (number - before == slices[1].first - slices[0].first) continue;
    return absl::InvalidArgumentError(absl::StrFormat(
        "'%s' follows '%s', but '%s' is followed by '%s': slices are missing, or are too many",
        name, name_before, slices[0].second, slices[1].second));
  }
  return absl::OkStatus();
}

std::string KindOf(const ImageInfo& info) {
  return absl::StrFormat("%d x %d pixels of %s", info.size.nx, info.size.ny,
                         std::string(VoxelTypeName(info.type)));
}

// One file is open at a time.
class SliceSeries : public ImageSource {
 public:
  SliceSeries(std::vector<std::string> names, Open open, std::unique_ptr<ImageSource> first,
              ImageInfo info)
      : ImageSource(std::move(info)),
        names_(std::move(names)),
        open_(std::move(open)),
        slice_(std::move(first)) {}

 private:
  absl::StatusOr<SliceValues> ReadSlice(int32_t z) override {
    const std::string& name = names_[static_cast<size_t>(z)];
    if (z > 0) slice_ = nullptr;  // at most one file is open
    const absl::StatusOr<ImageSlice> slice = Read(name);
    if (slice.ok()) return slice->values;
    return absl::Status(slice.status().code(),
                        absl::StrFormat("slice '%s': %s", name, slice.status().message()));
  }

  absl::StatusOr<ImageSlice> Read(const std::string& name) {
    if (slice_ == nullptr) {
      BCCSKEL_ASSIGN_OR_RETURN(slice_, open_(name));
    }
    const ImageInfo& info = slice_->info();
    if (info.size.nz != 1) {
      return absl::InvalidArgumentError(
          absl::StrFormat("holds %d slices; each of several files must hold one", info.size.nz));
    }
    if (info.size.nx == info_.size.nx && info.size.ny == info_.size.ny && info.type == info_.type) {
      return slice_->NextSlice();
    }
    return absl::InvalidArgumentError(
        absl::StrFormat("has %s, the first one, '%s', has %s; all must be alike", KindOf(info),
                        names_.front(), KindOf(info_)));
  }

  std::vector<std::string> names_;
  Open open_;
  std::unique_ptr<ImageSource> slice_;
};

}  // namespace

bool IsTiffName(std::string_view name) {
  const std::string lower = LowerCase(name);
  return lower.ends_with(".tif") || lower.ends_with(".tiff");
}

std::vector<std::string> SliceNamesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    const std::string name = entry->path().filename().string();
    if (IsSliceName(name) && entry->is_regular_file(ignored)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

absl::StatusOr<std::vector<std::string>> InOrderOfNumbers(std::vector<std::string> names) {
  const auto tiffs = std::ranges::count_if(names, IsTiffName), all = std::ssize(names);
  if (tiffs > 0 && tiffs < all) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the folder holds %d PNG and %d TIFF files; slices of one image must be "
                        "alone in a folder",
                        all - tiffs, tiffs));
  }
  if (names.size() < 2) return names;
  const NamePattern pattern = PatternOf(names);
  Numbered slices;
  for (const std::string& name : names) {
    const std::optional<uint64_t> number = NumberIn(name, pattern);
    if (!number.has_value()) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "'%s' and '%s' are not slices of one image: names of slices must be alike but for one "
          "number, and slices of one image alone in a folder",
          names.front(), name == names.front() ? names.back() : name));
    }
    slices.emplace_back(*number, name);
  }
  std::ranges::sort(slices);
  BCCSKEL_RETURN_IF_ERROR(CheckSteps(slices));
  std::ranges::transform(slices, names.begin(),
                         [](auto& slice) { return std::move(slice.second); });
  return names;
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenSeries(std::vector<std::string> names,
                                                        const ImageLimits& limits, Open open) {
  absl::StatusOr<std::unique_ptr<ImageSource>> first = open(names.front());
  if (!first.ok()) {
    return absl::Status(first.status().code(),
                        absl::StrFormat("slice '%s': %s", names.front(), first.status().message()));
  }
  if (names.size() == 1) return first;
  ImageInfo info = (*first)->info();
  const std::array<int64_t, 3> lengths = {info.size.nx, info.size.ny, std::ssize(names)};
  BCCSKEL_ASSIGN_OR_RETURN(info.size, SizeOfAxes(lengths, limits));
  return std::make_unique<SliceSeries>(std::move(names), std::move(open), *std::move(first),
                                       std::move(info));
}

}  // namespace bccskel
