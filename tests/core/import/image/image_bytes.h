#ifndef BCCSKEL_TESTS_CORE_IMPORT_IMAGE_IMAGE_BYTES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_IMAGE_IMAGE_BYTES_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/open_image.h"
#include "tests/support/deflated.h"

// Images byte by byte, as the formats' documents say, and what is read of them.
namespace bccskel::testing {

template <typename Number>
std::string Bytes(Number number, std::endian order = std::endian::little) {
  std::string bytes(sizeof(Number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(Number));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// What an image holds, all values as double, x fastest.
struct ReadImage {
  ImageInfo info;
  std::vector<double> values;
};

inline absl::StatusOr<ReadImage> ReadAll(absl::StatusOr<std::unique_ptr<ImageSource>> source) {
  if (!source.ok()) return source.status();
  ReadImage image = {.info = (*source)->info(), .values = {}};
  for (int32_t z = 0; z < image.info.size.nz; ++z) {
    const absl::StatusOr<ImageSlice> slice = (*source)->NextSlice();
    if (!slice.ok()) return slice.status();
    std::visit(
        [&image](const auto values) {
          for (const auto value : values) image.values.push_back(static_cast<double>(value));
        },
        slice->values);
  }
  if ((*source)->NextSlice().status().code() != absl::StatusCode::kOutOfRange) std::abort();
  return image;
}

inline absl::StatusOr<ReadImage> ReadBytes(const std::string& bytes,
                                           const ImageOptions& options = {}) {
  return ReadAll(OpenImageBytes("test", bytes, options));
}

// What was read; a failure, with the reason, where it was not.
inline ReadImage MustRead(absl::StatusOr<ReadImage> image) {
  EXPECT_TRUE(image.ok()) << image.status();
  return image.ok() ? *std::move(image) : ReadImage();
}

// Why bytes are no image; empty where they are one.
inline std::string ErrorOfBytes(const std::string& bytes, const ImageOptions& options = {}) {
  return std::string(ReadBytes(bytes, options).status().message());
}

// 0, 1, 2, ... of a type, as many as wanted.
template <typename Number>
std::string Counting(size_t count, std::endian order = std::endian::little) {
  std::string bytes;
  for (size_t n = 0; n < count; ++n) bytes += Bytes(static_cast<Number>(n), order);
  return bytes;
}

inline std::vector<double> CountedTo(size_t count) {
  std::vector<double> values(count);
  for (size_t n = 0; n < count; ++n) values[n] = static_cast<double>(n);
  return values;
}

// A NIfTI-1 header of 3 x 2 x 2 voxels of type uint8, spacing 1 x 2 x 3 mm, and its voxels' place.
inline std::string Nifti1Header(std::endian order = std::endian::little) {
  std::string header(352, '\0');
  const auto put = [&header](size_t at, const std::string& bytes) {
    std::copy(bytes.begin(), bytes.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
  };
  put(0, Bytes<int32_t>(348, order));
  const int16_t dims[] = {3, 3, 2, 2, 1, 1, 1, 1};
  for (size_t n = 0; n < 8; ++n) put(40 + 2 * n, Bytes(dims[n], order));
  put(70, Bytes<int16_t>(2, order));
  put(72, Bytes<int16_t>(8, order));
  const float pixdim[] = {1, 1, 2, 3, 0, 0, 0, 0};
  for (size_t n = 0; n < 8; ++n) put(76 + 4 * n, Bytes(pixdim[n], order));
  put(108, Bytes<float>(352, order));
  header[123] = 2;
  put(344, std::string("n+1\0", 4));
  return header;
}

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_IMAGE_IMAGE_BYTES_H_
