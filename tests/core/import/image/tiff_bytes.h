#ifndef BCCSKEL_TESTS_CORE_IMPORT_IMAGE_TIFF_BYTES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_IMAGE_TIFF_BYTES_H_

#include <tiffio.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/core/import/image/image_bytes.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::testing {

struct TiffPages {
  int count = 2;
  uint32_t width = 3;
  uint32_t height = 4;
  int bits = 8;
  int samples = 1;
  int compression = COMPRESSION_NONE;
  int photometric = PHOTOMETRIC_MINISBLACK;
  const char* description = "";
  uint8_t first = 0;
};

// Pages whose bytes count on from the first; the last one may be wider.
inline std::string TiffBytes(const TiffPages& pages, uint32_t last_width = 0) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "pages.tif";
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  uint8_t next = pages.first;
  for (int page = 0; page < pages.count; ++page) {
    const bool last = page + 1 == pages.count && last_width > 0;
    const uint32_t width = last ? last_width : pages.width;
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, pages.height);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, pages.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, pages.samples);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, pages.compression);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, pages.photometric);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 3);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 4.0);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 2.0);
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, pages.description);
    std::vector<uint8_t> row(static_cast<size_t>(TIFFScanlineSize(tiff)));
    for (uint32_t y = 0; y < pages.height; ++y) {
      for (uint8_t& byte : row) byte = next++;
      TIFFWriteScanline(tiff, row.data(), y, 0);
    }
    TIFFWriteDirectory(tiff);
  }
  TIFFClose(tiff);
  return test::BytesOfFile(path);
}

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_IMAGE_TIFF_BYTES_H_
