// NumPy's .npy, and .npz, which is a zip archive of these. The header is a Python dictionary of
// three entries; it is read, never run.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"
#include "core/import/image/zip_archive.h"

namespace bccskel {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";

// What stands behind the key, up to the end of the dictionary.
absl::StatusOr<std::string_view> ValueOf(std::string_view dictionary, std::string_view key) {
  const std::string quoted = absl::StrFormat("'%s'", std::string(key));
  const size_t at = dictionary.find(quoted);
  if (at != dictionary.npos) {
    const auto value = SplitAt(dictionary.substr(at + quoted.size()), ":");
    if (value.has_value() && value->first.empty()) return value->second;
  }
  return absl::InvalidArgumentError(absl::StrFormat("the header lacks '%s'", std::string(key)));
}

absl::Status BadElements(std::string_view descr) {
  constexpr std::string_view kRecords = "[('";
  if (descr.starts_with(kRecords)) {
    const std::string_view name = descr.substr(kRecords.size());
    return absl::InvalidArgumentError(
        absl::StrFormat("elements are records; save one of their fields: numpy.save(FILE, "
                        "array['%s'])",
                        std::string(name.substr(0, std::min(name.find('\''), size_t{80})))));
  }
  return absl::InvalidArgumentError(absl::StrFormat(
      "elements of type %s are not supported, only plain integers, floats and bools are",
      std::string(descr.substr(0, descr.find(',')).substr(0, 80))));
}

absl::StatusOr<NumpyType> ElementsOf(std::string_view dictionary) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view descr, ValueOf(dictionary, "descr"));
  if (descr.size() < 5 || descr[0] != '\'' || descr[4] != '\'') return BadElements(descr);
  const std::optional<NumpyType> type = NumpyTypeOf(descr.substr(1, 3));
  if (!type.has_value()) return BadElements(descr);
  return *type;
}

absl::StatusOr<VoxelOrder> VoxelOrderOf(std::string_view dictionary) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view text, ValueOf(dictionary, "fortran_order"));
  if (text.starts_with("False")) return VoxelOrder::kXFastest;
  if (text.starts_with("True")) return VoxelOrder::kZFastest;
  return absl::InvalidArgumentError("'fortran_order' is neither True nor False");
}

// The lengths of the axes as NumPy names them, the one of x last.
absl::StatusOr<std::vector<int64_t>> ShapeOf(std::string_view dictionary) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view text, ValueOf(dictionary, "shape"));
  const size_t end = text.find(')');
  if (!text.starts_with('(') || end == text.npos) {
    return absl::InvalidArgumentError("'shape' is not a tuple of numbers");
  }
  std::vector<int64_t> shape;
  for (const std::string_view word : Words(text.substr(1, end - 1), ",")) {
    BCCSKEL_ASSIGN_OR_RETURN(shape.emplace_back(), RequireNumber<int64_t>("shape", word));
  }
  constexpr size_t kMaxAxes = 32;  // NumPy's own limit
  if (shape.size() <= kMaxAxes) return shape;
  return absl::InvalidArgumentError(
      absl::StrFormat("'shape' has %d axes, the limit is %d", shape.size(), kMaxAxes));
}

// Fastest first; an axis of length 1 on either side of more than three is dropped.
std::vector<int64_t> NpyAxesOf(std::vector<int64_t> shape) {
  std::ranges::reverse(shape);
  while (shape.size() > 3 && shape.back() == 1) shape.pop_back();
  while (shape.size() > 3 && shape.front() == 1) shape.erase(shape.begin());
  return shape;
}

struct Header {
  std::string_view dictionary;
  size_t bytes;  // where the elements begin
};

absl::StatusOr<Header> HeaderOf(std::string_view front) {
  if (front.size() < 12) return absl::InvalidArgumentError("the header is cut");
  const int version = static_cast<unsigned char>(front[6]);
  if (version < 1 || version > 3) {
    return absl::InvalidArgumentError(
        absl::StrFormat("version %d of the format, it must be 1, 2 or 3", version));
  }
  const size_t width = version == 1 ? 2 : 4;
  size_t length = 0;
  for (size_t n = width; n-- > 0;) length = length << 8 | static_cast<unsigned char>(front[8 + n]);
  const size_t bytes = 8 + width + length;
  if (bytes <= front.size()) return Header{front.substr(8 + width, length), bytes};
  return absl::InvalidArgumentError(absl::StrFormat(
      "the header declares %d bytes, %d are there to be read", bytes, front.size()));
}

// "'mask', 'labels', ..."
std::string NpyNamesOf(const std::vector<std::string>& arrays) {
  constexpr size_t kMost = 10;
  std::string names;
  for (size_t n = 0; n < std::min(kMost, arrays.size()); ++n) {
    absl::StrAppendFormat(&names, "%s'%s'", n == 0 ? "" : ", ", arrays[n]);
  }
  return arrays.size() > kMost ? names + ", ..." : names;
}

// The number of the member that holds the wanted array, or the only one.
absl::StatusOr<uint64_t> ChosenArray(const std::vector<std::string>& members,
                                     const std::optional<std::string>& wanted) {
  constexpr std::string_view kEnding = ".npy";
  std::vector<std::string> arrays;
  std::optional<uint64_t> chosen;
  for (size_t n = 0; n < members.size(); ++n) {
    if (!members[n].ends_with(kEnding)) continue;
    arrays.push_back(members[n].substr(0, members[n].size() - kEnding.size()));
    if (!wanted.has_value() || *wanted == arrays.back()) chosen = n;
  }
  if (arrays.empty()) return absl::InvalidArgumentError("the zip archive holds no .npy array");
  if (wanted.has_value() && !chosen.has_value()) {
    return absl::InvalidArgumentError(absl::StrFormat("--array '%s' is not there; there %s %s",
                                                      *wanted, arrays.size() == 1 ? "is" : "are",
                                                      NpyNamesOf(arrays)));
  }
  if (wanted.has_value() || arrays.size() == 1) return *chosen;
  return absl::InvalidArgumentError(
      absl::StrFormat("the file holds %d arrays, %s; choose one with --array NAME", arrays.size(),
                      NpyNamesOf(arrays)));
}

}  // namespace

std::optional<NumpyType> NumpyTypeOf(std::string_view name) {
  if (name.size() != 3 || std::string_view("<>|").find(name[0]) == name.npos) return std::nullopt;
  const std::string_view kind = name.substr(1);
  NumpyType number = {.byte_order = name[0] == '>' ? std::endian::big : std::endian::little};
  if (kind == "f2") {
    number.type = VoxelType::kUint16;
    number.halves = StoredHalves::kYes;
  } else if (kind != "b1") {
    const auto type = ParseVoxelType(absl::StrFormat("%c%d", kind[0], 8 * (kind[1] - '0')));
    if (!type.ok()) return std::nullopt;
    number.type = *type;
  }
  // A bar stands for no order, which only single bytes do without.
  if (name[0] == '|' && kind[1] != '1') return std::nullopt;
  return number;
}

bool IsNpy(std::string_view front) { return front.starts_with(kNpyMagic); }

absl::StatusOr<StoredImage> ParseNpy(const ImageFront& front, const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const Header header, HeaderOf(front.bytes));
  StoredImage image;
  image.info.format = "npy";
  BCCSKEL_ASSIGN_OR_RETURN(const NumpyType elements, ElementsOf(header.dictionary));
  image.stored_type = elements.type;
  image.halves = elements.halves;
  image.byte_order = elements.byte_order;
  BCCSKEL_ASSIGN_OR_RETURN(image.voxel_order, VoxelOrderOf(header.dictionary));
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> shape, ShapeOf(header.dictionary));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOfAxes(NpyAxesOf(std::move(shape)), limits));
  BCCSKEL_RETURN_IF_ERROR(PlaceBehindHeader(front, header.bytes, Compression::kNone, image));
  return image;
}

absl::StatusOr<StoredImage> ParseNpz(const std::shared_ptr<const ImageFile>& file,
                                     const std::optional<std::string>& array,
                                     const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<std::string> members, ZipNames(file));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t member, ChosenArray(members, array));
  BCCSKEL_ASSIGN_OR_RETURN(const ImageFront front, ReadMemberFront(file, member, limits));
  if (IsNpy(front.bytes)) return ParseNpy(front, limits);
  return absl::InvalidArgumentError(
      absl::StrFormat("'%s' in it is not an npy file", members[member]));
}

}  // namespace bccskel
