#ifndef BCCSKEL_TESTS_CORE_IMPORT_IMAGE_PNG_BYTES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_IMAGE_PNG_BYTES_H_

#include <png.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace bccskel::testing {

// A picture as libpng writes it. `samples` are those of the rows, red, green, blue and alpha of a
// pixel together; of 16 bits each, whatever `bits` says.
struct PngPicture {
  uint32_t width = 3;
  uint32_t height = 2;
  int bits = 8;
  int color = PNG_COLOR_TYPE_GRAY;
  int interlace = PNG_INTERLACE_NONE;
  std::vector<uint16_t> samples;
  int clear = -1;  // the gray level that means transparent
};

inline void AppendBits(std::string& row, size_t& bit, uint16_t value, int bits) {
  for (int n = bits - 1; n >= 0; --n, ++bit) {
    if (bit % 8 == 0) row.push_back(0);
    row.back() = static_cast<char>(row.back() | (value >> n & 1) << (7 - bit % 8));
  }
}

inline std::string PngBytes(const PngPicture& picture) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) != 0) std::abort();
  const auto append = [](png_structp writer, png_bytep from, size_t size) {
    static_cast<std::string*>(png_get_io_ptr(writer))
        ->append(reinterpret_cast<const char*>(from), size);
  };
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_IHDR(png, info, picture.width, picture.height, picture.bits, picture.color,
               picture.interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (picture.color == PNG_COLOR_TYPE_PALETTE) {
    // All of one color: what is read must be the index.
    const std::vector<png_color> palette(size_t{1} << picture.bits, png_color{9, 9, 9});
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  }
  png_color_16 clear = {};
  clear.gray = static_cast<uint16_t>(picture.clear);
  if (picture.clear >= 0) png_set_tRNS(png, info, nullptr, 0, &clear);
  const size_t row_samples = picture.samples.size() / picture.height;
  std::vector<std::string> rows(picture.height);
  std::vector<png_bytep> starts;
  for (size_t y = 0; y < rows.size(); ++y) {
    size_t bit = 0;
    for (size_t n = 0; n < row_samples; ++n) {
      AppendBits(rows[y], bit, picture.samples[y * row_samples + n], picture.bits);
    }
    starts.push_back(reinterpret_cast<png_bytep>(rows[y].data()));
  }
  png_set_rows(png, info, starts.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_IMAGE_PNG_BYTES_H_
