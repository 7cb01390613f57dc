#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/dicom_header.h"
#include "core/import/image/image_readers.h"

namespace bccskel {
namespace {

using Headers = std::vector<DicomHeader>;

// "3 'Thorax' (120 files, 1.2.840.1)"
std::string NameOf(const Headers& series) {
  const DicomHeader& first = series.front();
  return absl::StrFormat(
      "%s '%s' (%d %s, %s)", first.series_number.empty() ? "-" : first.series_number,
      first.series_description, series.size(), series.size() == 1 ? "file" : "files", first.series);
}

using AllSeries = std::map<std::string, Headers>;

std::string NamesOf(const AllSeries& all) {
  constexpr int kMostNames = 8;
  std::string names;
  int count = 0;
  for (const auto& [uid, series] : all) {
    if (count == kMostNames) return names + ", ...";
    names += (count++ == 0 ? "" : ", ") + NameOf(series);
  }
  return names;
}

absl::StatusOr<Headers> ChosenSeries(AllSeries all, const std::optional<std::string>& choice) {
  Headers found;
  int matches = 0;
  for (const auto& [uid, series] : all) {
    if (choice.has_value() && *choice != uid && *choice != series.front().series_number) continue;
    found = series;
    ++matches;
  }
  if (matches == 1) return found;
  if (!choice.has_value()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the folder holds %d series: %s; choose one with --series NUMBER or --series UID",
        all.size(), NamesOf(all)));
  }
  return absl::InvalidArgumentError(absl::StrFormat("--series '%s' is %s series of the folder: %s",
                                                    *choice, matches == 0 ? "no" : "not only one",
                                                    NamesOf(all)));
}

// The files of the folder that hold images, by their series.
absl::StatusOr<AllSeries> ReadFolder(const std::string& path) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) names.push_back(entry->path().string());
  }
  if (error) return absl::InvalidArgumentError(error.message());
  std::ranges::sort(names);
  AllSeries all;
  for (const std::string& name : names) {
    if (!IsDicomFile(name)) continue;
    BCCSKEL_ASSIGN_OR_RETURN(DicomHeader header, ReadDicomHeader(name));
    if (header.kind != DicomKind::kOther) all[header.series].push_back(std::move(header));
  }
  if (!all.empty()) return all;
  return absl::InvalidArgumentError("none of the DICOM files in the folder is an image");
}

}  // namespace

absl::StatusOr<std::vector<DicomHeader>> DicomFilesOf(const std::string& path,
                                                      const ImageOptions& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    BCCSKEL_ASSIGN_OR_RETURN(AllSeries all, ReadFolder(path));
    return ChosenSeries(std::move(all), options.series);
  }
  if (options.series.has_value()) {
    return absl::InvalidArgumentError("--series applies only to folders of DICOM files");
  }
  BCCSKEL_ASSIGN_OR_RETURN(DicomHeader header, ReadDicomHeader(path));
  if (header.kind == DicomKind::kOther) {
    return absl::InvalidArgumentError("the DICOM file is not an image");
  }
  return Headers{std::move(header)};
}

}  // namespace bccskel
