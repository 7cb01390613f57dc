#include "client/export/picture/png.h"

#include <zlib.h>

#include <cstdint>
#include <utility>

#include "client/view/packed_numbers.h"

namespace bccskel::exporting {
namespace {

void AppendBigEndian(std::string& bytes, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<char>(value >> shift & 0xff));
  }
}

void AppendChunk(std::string& png, std::string_view type, std::string_view body) {
  AppendBigEndian(png, static_cast<uint32_t>(body.size()));
  const size_t start = png.size();
  png.append(type).append(body);
  const auto* checked = reinterpret_cast<const Bytef*>(png.data() + start);
  AppendBigEndian(png, static_cast<uint32_t>(crc32_z(0, checked, png.size() - start)));
}

std::string HeaderOf(const RgbaImage& image) {
  std::string header;
  AppendBigEndian(header, image.width);
  AppendBigEndian(header, image.height);
  header.append({8, 6, 0, 0, 0});  // bits per sample, RGBA, deflate, filters, not interlaced
  return header;
}

// Rows with filter 2 (each byte minus the byte above): smooth images shrink to a third.
std::string FilteredRows(const RgbaImage& image) {
  constexpr char kUpFilter = 2;
  const size_t row_bytes = size_t{4} * image.width;
  std::string rows;
  rows.reserve((row_bytes + 1) * image.height);
  for (size_t y = 0; y < image.height; ++y) {
    rows.push_back(kUpFilter);
    for (size_t n = y * row_bytes; n < (y + 1) * row_bytes; ++n) {
      const int above = y == 0 ? 0 : image.pixels[n - row_bytes];
      rows.push_back(static_cast<char>(image.pixels[n] - above));
    }
  }
  return rows;
}

}  // namespace

absl::StatusOr<std::string> EncodePng(const RgbaImage& image) {
  absl::StatusOr<std::string> rows = view::Deflate(FilteredRows(image));
  if (!rows.ok()) return std::move(rows).status();
  std::string png = "\x89PNG\r\n\x1a\n";
  AppendChunk(png, "IHDR", HeaderOf(image));
  AppendChunk(png, "IDAT", *rows);
  AppendChunk(png, "IEND", "");
  return png;
}

}  // namespace bccskel::exporting
