#include "client/export/picture/png.h"

#include <zlib.h>

#include <cstdint>
#include <utility>

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

absl::StatusOr<std::string> Compress(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string compressed(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(compressed.data()), &size,
                             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 6);
  if (code != Z_OK) return absl::ResourceExhaustedError("not enough memory to compress a picture");
  compressed.resize(size);
  return compressed;
}

}  // namespace

absl::StatusOr<std::string> EncodePng(const RgbaImage& image) {
  absl::StatusOr<std::string> rows = Compress(FilteredRows(image));
  if (!rows.ok()) return std::move(rows).status();
  std::string png = "\x89PNG\r\n\x1a\n";
  AppendChunk(png, "IHDR", HeaderOf(image));
  AppendChunk(png, "IDAT", *rows);
  AppendChunk(png, "IEND", "");
  return png;
}

std::string EncodeBase64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t n = 0; n < bytes.size(); n += 3) {
    const size_t rest = bytes.size() - n;
    const auto byte = [&](size_t i) {
      return i < rest ? static_cast<uint32_t>(static_cast<uint8_t>(bytes[n + i])) : 0u;
    };
    const uint32_t triple = byte(0) << 16 | byte(1) << 8 | byte(2);
    text.push_back(kDigits[triple >> 18]);
    text.push_back(kDigits[triple >> 12 & 63]);
    text.push_back(rest > 1 ? kDigits[triple >> 6 & 63] : '=');
    text.push_back(rest > 2 ? kDigits[triple & 63] : '=');
  }
  return text;
}

}  // namespace bccskel::exporting
