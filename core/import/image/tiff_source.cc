#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/byte_stream.h"
#include "core/import/image/image_readers.h"
#include "core/import/image/slice_buffer.h"
#include "core/import/image/tiff_client.h"
#include "core/import/image/tiff_stack.h"

namespace bccskel {
namespace {

// A page as its tags tell it.
struct Page {
  uint32_t width = 0;
  uint32_t height = 0;
  VoxelType type = VoxelType::kUint8;
  int bits = 8;  // 1, or the bits of `type`

  friend bool operator==(const Page&, const Page&) = default;
};

template <typename T>
T TagOr(TIFF* tiff, uint32_t tag, T default_value) {
  T value = default_value;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : default_value;
}

absl::StatusOr<VoxelType> TypeOf(int bits, int format) {
  if (bits == 1) return VoxelType::kUint8;
  const char kind = format == SAMPLEFORMAT_INT ? 'i' : format == SAMPLEFORMAT_IEEEFP ? 'f' : 'u';
  const absl::StatusOr<VoxelType> type = ParseVoxelType(absl::StrFormat("%c%d", kind, bits));
  if (type.ok() && format != SAMPLEFORMAT_COMPLEXINT && format != SAMPLEFORMAT_COMPLEXIEEEFP) {
    return *type;
  }
  return absl::InvalidArgumentError(absl::StrFormat(
      "samples of %d bits in format %d; integers of 1, 8, 16, 32 and 64 bits and floats of 32 and "
      "64 are read",
      bits, format));
}

// As Aperio (33003 to 33005) and Bio-Formats write it.
bool IsJpeg2000(uint16_t compression) {
  return (compression >= 33003 && compression <= 33005) || compression == 34712;
}

absl::Status CheckCompression(TIFF* tiff) {
  const auto compression = TagOr<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (TIFFIsCODECConfigured(compression) != 0) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s (%d) is not supported; `bfconvert -compression LZW` of Bio-Formats writes a file that is",
      IsJpeg2000(compression) ? "JPEG 2000 compression" : "its compression", compression));
}

absl::StatusOr<Page> PageOf(TIFF* tiff) {
  BCCSKEL_RETURN_IF_ERROR(CheckCompression(tiff));
  Page page;
  page.width = TagOr<uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  page.height = TagOr<uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  const int samples = TagOr<uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  if (samples != 1) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%d samples per pixel, as of colors; only 1 is read: save one channel as an "
        "image of its own",
        samples));
  }
  page.bits = TagOr<uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  const int format = TagOr<uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  BCCSKEL_ASSIGN_OR_RETURN(page.type, TypeOf(page.bits, format));
  return page;
}

std::string_view DescriptionOf(TIFF* tiff) {
  const char* text = nullptr;
  const bool there = TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr;
  return there ? text : "";
}

// Without a unit the resolution is that of a printer, mostly by accident; so it is with an inch, by
// which ImageJ means dots per inch.
absl::StatusOr<Placement> PlacementOf(TIFF* tiff, const TiffStack& stack) {
  const auto stated = [](const std::optional<double>& spacing) { return spacing.has_value(); };
  if (std::ranges::none_of(stack.spacing, stated)) return Placement{};
  const auto per_unit = [tiff](uint32_t tag) {
    const float resolution = TagOr<float>(tiff, tag, 1.0F);
    return resolution > 0 ? 1 / static_cast<double>(resolution) : 1.0;
  };
  std::array<std::optional<double>, 3> spacing = stack.spacing;
  if (stack.has_resolution_tags) {
    spacing[0] = stack.factors[0] * per_unit(TIFFTAG_XRESOLUTION);
    spacing[1] = stack.factors[1] * per_unit(TIFFTAG_YRESOLUTION);
  }
  // Pixels are mostly square.
  return PlacementOfSpacing({spacing[0].value_or(spacing[1].value_or(1)),
                             spacing[1].value_or(spacing[0].value_or(1)), spacing[2].value_or(1)},
                            {0, 0, 0});
}

// Ratios that a stream of these compressions cannot exceed, so that a small file cannot ask for
// much memory; for the others the limit of a slice stands alone.
uint64_t MaxRatio(TIFF* tiff) {
  switch (TagOr<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE)) {
    case COMPRESSION_NONE:
      return 1;
    case COMPRESSION_PACKBITS:
      return 64;
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
      return kMaxDeflateRatio;
    default:
      return uint64_t{1} << 16;
  }
}

absl::Status CheckLength(TIFF* tiff, const Page& page, uint64_t file_bytes) {
  const uint64_t row = (static_cast<uint64_t>(page.width) * static_cast<uint64_t>(page.bits)) / 8;
  const uint64_t declared = row * page.height;
  const uint64_t most = file_bytes * MaxRatio(tiff);
  if (declared <= most) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("a page of %d x %d declares %d bytes; the file of %d bytes cannot hold them",
                      page.width, page.height, declared, file_bytes));
}

// A strip or a tile: where it lies in the page and how much of it is inside.
struct Block {
  uint32_t x, y, width, height;  // inside the page
  uint64_t row_bytes;            // of the decoded block
};

void CopyBits(const std::byte* from, uint32_t pixels, std::byte* to) {
  for (uint32_t x = 0; x < pixels; ++x) {
    to[x] = (from[x / 8] >> (7 - x % 8)) & std::byte{1};
  }
}

class TiffSource : public ImageSource {
 public:
  // Needs: the client is at the stack's first page.
  TiffSource(std::unique_ptr<TiffClient> client, const Page& page, const TiffStack& stack,
             ImageInfo info)
      : ImageSource(std::move(info)),
        client_(std::move(client)),
        page_(page),
        page_step_(stack.page_step) {}

 private:
  TIFF* tiff() const { return client_->tiff(); }

  absl::StatusOr<SliceValues> ReadSlice(int32_t z) override {
    z_ = z;
    if (z > 0) BCCSKEL_RETURN_IF_ERROR(GoToNextPage());
    slice_.Resize(page_.type, info_.size.SliceVoxels());
    BCCSKEL_RETURN_IF_ERROR(TIFFIsTiled(tiff()) != 0 ? ReadTiles() : ReadStrips());
    return slice_.values();
  }

  absl::Status GoToNextPage() {
    for (int64_t n = 0; n < page_step_; ++n) {
      if (TIFFReadDirectory(tiff()) == 1) continue;
      return client_->Error(absl::StrFormat("the page of slice %d cannot be read", z_));
    }
    BCCSKEL_ASSIGN_OR_RETURN(const Page page, PageOf(tiff()));
    if (page == page_) return CheckLength(tiff(), page, client_->file().size());
    return absl::InvalidArgumentError(absl::StrFormat(
        "the page of slice %d (counted from 0) has %d x %d pixels of %d bits, the first one %d x "
        "%d of %d; all "
        "must be alike",
        z_, page.width, page.height, page.bits, page_.width, page_.height, page_.bits));
  }

  absl::Status ReadStrips() {
    const auto rows = std::clamp<uint32_t>(
        TagOr<uint32_t>(tiff(), TIFFTAG_ROWSPERSTRIP, page_.height), 1, page_.height);
    const auto row_bytes = static_cast<uint64_t>(TIFFScanlineSize64(tiff()));
    BCCSKEL_RETURN_IF_ERROR(SizeBlock(row_bytes, rows, page_.width));
    for (uint32_t y = 0; y < page_.height; y += rows) {
      const uint32_t height = std::min(rows, page_.height - y);
      const auto wanted = static_cast<tmsize_t>(row_bytes * height);
      const tmsize_t got = TIFFReadEncodedStrip(tiff(), y / rows, block_.data(), wanted);
      if (got != wanted) return Damaged("strip", y / rows);
      Copy({0, y, page_.width, height, row_bytes});
    }
    return absl::OkStatus();
  }

  absl::Status ReadTiles() {
    const auto width = TagOr<uint32_t>(tiff(), TIFFTAG_TILEWIDTH, 0);
    const auto height = TagOr<uint32_t>(tiff(), TIFFTAG_TILELENGTH, 0);
    if (width == 0 || height == 0) return client_->Error("tiles without a size");
    const auto row_bytes = static_cast<uint64_t>(TIFFTileRowSize64(tiff()));
    BCCSKEL_RETURN_IF_ERROR(SizeBlock(row_bytes, height, width));
    for (uint32_t y = 0; y < page_.height; y += std::min(height, page_.height - y)) {
      for (uint32_t x = 0; x < page_.width; x += std::min(width, page_.width - x)) {
        const uint32_t tile = TIFFComputeTile(tiff(), x, y, 0, 0);
        const auto wanted = static_cast<tmsize_t>(block_.size());
        const tmsize_t got = TIFFReadEncodedTile(tiff(), tile, block_.data(), wanted);
        if (got != wanted) return Damaged("tile", tile);
        Copy({x, y, std::min(width, page_.width - x), std::min(height, page_.height - y),
              row_bytes});
      }
    }
    return absl::OkStatus();
  }

  // A tile may be larger than the page; honest ones are so by less than a tile's width.
  absl::Status SizeBlock(uint64_t row_bytes, uint64_t rows, uint64_t columns) {
    constexpr uint64_t kMaxTileSide = 1 << 16;
    constexpr uint64_t kMaxTileBytes = uint64_t{1} << 28;
    const uint64_t page_bytes = info_.size.SliceVoxels() * 8;
    const bool wide_enough = row_bytes >= (columns * static_cast<uint64_t>(page_.bits) + 7) / 8;
    if (!wide_enough || row_bytes / 8 > std::max<uint64_t>(page_.width, kMaxTileSide) ||
        rows > std::max<uint64_t>(page_.height, kMaxTileSide) ||
        row_bytes * rows > std::max(page_bytes, kMaxTileBytes)) {
      return client_->Error(
          absl::StrFormat("strips or tiles of %d rows of %d bytes", rows, row_bytes));
    }
    block_.resize(static_cast<size_t>(row_bytes * rows));
    return absl::OkStatus();
  }

  void Copy(const Block& block) {
    const size_t bytes = VoxelBytes(page_.type);
    for (uint32_t y = 0; y < block.height; ++y) {
      const std::byte* from = block_.data() + y * block.row_bytes;
      std::byte* to = slice_.bytes().data() +
                      (static_cast<size_t>(block.y + y) * page_.width + block.x) * bytes;
      if (page_.bits == 1) {
        CopyBits(from, block.width, to);
      } else {
        std::memcpy(to, from, block.width * bytes);
      }
    }
  }

  absl::Status Damaged(const char* what, uint32_t number) {
    return client_->Error(absl::StrFormat("page %d, %s %d is cut or damaged", z_, what, number));
  }

  std::unique_ptr<TiffClient> client_;
  Page page_;
  int64_t page_step_;
  SliceBuffer slice_;
  std::vector<std::byte> block_;
  int32_t z_ = 0;  // of the page
};

}  // namespace

bool IsTiff(std::string_view front) {
  for (const std::string_view magic :
       {std::string_view("II*\0", 4), std::string_view("MM\0*", 4), std::string_view("II+\0", 4),
        std::string_view("MM\0+", 4)}) {
    if (front.starts_with(magic)) return true;
  }
  return false;
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenTiff(std::shared_ptr<const ImageFile> file,
                                                      const ImageOptions& options) {
  const ImageLimits& limits = options.limits;
  BCCSKEL_ASSIGN_OR_RETURN(auto client,
                           TiffClient::Open(std::move(file), 8 * limits.max_slice_voxels));
  TIFF* const tiff = client->tiff();
  const auto pages = static_cast<int64_t>(TIFFNumberOfDirectories(tiff));
  if (TIFFSetDirectory(tiff, 0) != 1) return client->Error("the first page is damaged");
  BCCSKEL_RETURN_IF_ERROR(PageOf(tiff).status());  // colors are refused as such
  BCCSKEL_ASSIGN_OR_RETURN(const TiffStack stack, TiffStackOf(DescriptionOf(tiff), pages, options));
  BCCSKEL_ASSIGN_OR_RETURN(const Placement placement, PlacementOf(tiff, stack));
  if (stack.first_page > 0 && TIFFSetDirectory(tiff, static_cast<tdir_t>(stack.first_page)) != 1) {
    return client->Error(absl::StrFormat("page %d is damaged", stack.first_page));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const Page page, PageOf(tiff));
  ImageInfo info;
  info.format = "TIFF";
  info.type = page.type;
  info.unit = stack.unit;
  const std::array<int64_t, 3> lengths = {page.width, page.height, stack.slices};
  BCCSKEL_ASSIGN_OR_RETURN(info.size, SizeOfAxes(lengths, limits));
  BCCSKEL_RETURN_IF_ERROR(CheckLength(tiff, page, client->file().size()));
  info.placement = placement;
  return std::make_unique<TiffSource>(std::move(client), page, stack, std::move(info));
}

}  // namespace bccskel
