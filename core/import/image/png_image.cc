#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/uninitialized.h"
#include "core/import/image/byte_stream.h"
#include "core/import/image/image_readers.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {
namespace {

// libpng reading from an ImageFile, with its complaints kept instead of printed.
class PngClient {
 public:
  explicit PngClient(std::shared_ptr<const ImageFile> file) : file_(std::move(file)) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &Complain, &Ignore);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ != nullptr) png_set_read_fn(png_, this, &Read);
  }
  ~PngClient() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngClient(const PngClient&) = delete;
  PngClient& operator=(const PngClient&) = delete;

  bool ready() const { return info_ != nullptr; }
  png_structp png() const { return png_; }
  png_infop info() const { return info_; }
  uint64_t file_bytes() const { return file_->size(); }

  // Where libpng fails, it leaves by longjmp(), past destructors: `work` must only call libpng.
  template <typename Work>
  absl::Status Call(const char* what, const Work& work) {
    if (setjmp(png_jmpbuf(png_)) == 0) {
      work();
      return absl::OkStatus();
    }
    return absl::InvalidArgumentError(absl::StrFormat("%s: %s", what, complaint_.data()));
  }

 private:
  static void Read(png_structp png, png_bytep into, size_t wanted) {
    if (!static_cast<PngClient*>(png_get_io_ptr(png))->Fill(into, wanted)) {
      png_error(png, "the file is cut");
    }
  }

  bool Fill(png_bytep into, size_t wanted) {
    const absl::StatusOr<size_t> got =
        file_->ReadAt(offset_, std::span(reinterpret_cast<std::byte*>(into), wanted));
    offset_ += wanted;
    return got.ok() && *got == wanted;
  }

  [[noreturn]] static void Complain(png_structp png, png_const_charp text) {
    auto& complaint = static_cast<PngClient*>(png_get_error_ptr(png))->complaint_;
    std::strncpy(complaint.data(), text, complaint.size() - 1);
    png_longjmp(png, 1);
  }
  static void Ignore(png_structp, png_const_charp) {}

  std::shared_ptr<const ImageFile> file_;
  uint64_t offset_ = 0;
  std::array<char, 256> complaint_ = {};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

// How the rows are stored, once libpng has made samples of 1 and 2 bytes in this machine's order.
struct PngLayout {
  VoxelType type = VoxelType::kUint8;
  size_t colors = 1;  // samples of a pixel that must be equal
  bool alpha = false;
  std::optional<unsigned> clear;  // a gray level that means transparent
  int passes = 1;                 // above 1: every pass touches all rows
  size_t row_bytes = 0;
};

absl::StatusOr<PngLayout> LayoutOf(PngClient& client) {
  PngLayout layout;
  png_structp png = client.png();
  png_infop info = client.info();
  BCCSKEL_RETURN_IF_ERROR(client.Call("the header cannot be read", [&] {
    png_set_packing(png);
    if (std::endian::native == std::endian::little) png_set_swap(png);
    layout.passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    layout.row_bytes = png_get_rowbytes(png, info);
  }));
  const int colors = png_get_color_type(png, info);
  if (png_get_bit_depth(png, info) == 16) layout.type = VoxelType::kUint16;
  layout.alpha = (colors & PNG_COLOR_MASK_ALPHA) != 0;
  png_color_16p clear = nullptr;
  if (colors == PNG_COLOR_TYPE_GRAY &&
      png_get_tRNS(png, info, nullptr, nullptr, &clear) == PNG_INFO_tRNS && clear != nullptr) {
    layout.clear = clear->gray;
  }
  const bool red = (colors & PNG_COLOR_MASK_COLOR) != 0 && colors != PNG_COLOR_TYPE_PALETTE;
  layout.colors = red ? 3 : 1;
  return layout;
}

absl::Status CheckLength(const PngClient& client, const ImageSize& size) {
  const uint64_t row_bits = uint64_t{png_get_bit_depth(client.png(), client.info())} *
                            png_get_channels(client.png(), client.info()) *
                            static_cast<uint64_t>(size.nx);
  const uint64_t declared = row_bits / 8 * static_cast<uint64_t>(size.ny);
  if (declared <= client.file_bytes() * kMaxDeflateRatio) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("%d x %d pixels declare %d bytes; the file of %d bytes cannot hold them",
                      size.nx, size.ny, declared, client.file_bytes()));
}

absl::Status ColoredError(size_t x, int32_t y, std::span<const unsigned> rgb) {
  return absl::InvalidArgumentError(absl::StrFormat(
      "pixel (%d, %d) has the color %d, %d, %d; masks and labels are read from gray levels or the "
      "indices of a palette: save the image as gray",
      x, y, rgb[0], rgb[1], rgb[2]));
}

absl::Status TransparentError(size_t x, int32_t y, unsigned alpha) {
  return absl::InvalidArgumentError(absl::StrFormat(
      "pixel (%d, %d) is transparent (alpha %d), so its value is not certain: remove the "
      "transparency (ImageMagick: convert IN.png -background black -alpha remove -alpha off "
      "OUT.png), or, if it is the mask, take it (-alpha extract)",
      x, y, alpha));
}

// The black pixels of an image. Drawing programs leave the background transparent black; but beside
// opaque black that may be the mask.
struct Blacks {
  struct Pixel {
    size_t x;
    int32_t y;
  };
  std::optional<Pixel> clear;  // the first
  bool opaque = false;
};

// Takes the one gray level out of each pixel's samples.
template <typename T>
absl::Status TakeGray(const std::byte* row, const PngLayout& layout, int32_t y, std::span<T> grays,
                      Blacks& blacks) {
  const size_t samples = layout.colors + (layout.alpha ? 1 : 0);
  std::array<T, 4> pixel = {};
  for (size_t x = 0; x < grays.size(); ++x, row += samples * sizeof(T)) {
    std::memcpy(pixel.data(), row, samples * sizeof(T));
    const bool gray = layout.colors == 1 || (pixel[0] == pixel[1] && pixel[0] == pixel[2]);
    if (!gray) return ColoredError(x, y, std::array<unsigned, 3>{pixel[0], pixel[1], pixel[2]});
    if (pixel[0] > 0 && layout.clear == pixel[0]) return TransparentError(x, y, 0);
    const T alpha = layout.alpha ? pixel[layout.colors] : std::numeric_limits<T>::max();
    const bool opaque = alpha == std::numeric_limits<T>::max();
    if (!opaque && (alpha > 0 || pixel[0] > 0)) return TransparentError(x, y, alpha);
    if (!opaque && !blacks.clear.has_value()) blacks.clear = {x, y};
    blacks.opaque = blacks.opaque || (opaque && pixel[0] == 0);
    grays[x] = pixel[0];
  }
  return blacks.clear.has_value() && blacks.opaque
             ? TransparentError(blacks.clear->x, blacks.clear->y, 0)
             : absl::OkStatus();
}

class PngSource : public ImageSource {
 public:
  PngSource(std::unique_ptr<PngClient> client, const PngLayout& layout, ImageInfo info)
      : ImageSource(std::move(info)), client_(std::move(client)), layout_(layout) {}

 private:
  absl::StatusOr<SliceValues> ReadSlice(int32_t) override {
    slice_.Resize(info_.type, info_.size.SliceVoxels());
    BCCSKEL_RETURN_IF_ERROR(ReadRows());
    return slice_.values();
  }

  absl::Status ReadRows() {
    const bool interlaced = layout_.passes > 1;
    rows_.resize(layout_.row_bytes * (interlaced ? static_cast<size_t>(info_.size.ny) : 1));
    for (int pass = 1; pass <= layout_.passes; ++pass) {
      for (int32_t y = 0; y < info_.size.ny; ++y) {
        std::byte* row =
            rows_.data() + (interlaced ? static_cast<size_t>(y) : 0) * layout_.row_bytes;
        BCCSKEL_RETURN_IF_ERROR(client_->Call("the pixels cannot be read", [&] {
          png_read_row(client_->png(), reinterpret_cast<png_bytep>(row), nullptr);
        }));
        if (pass == layout_.passes) BCCSKEL_RETURN_IF_ERROR(Take(row, y));
      }
    }
    return client_->Call("the end cannot be read", [&] { png_read_end(client_->png(), nullptr); });
  }

  absl::Status Take(const std::byte* row, int32_t y) {
    const auto nx = static_cast<size_t>(info_.size.nx);
    const auto take = [&]<typename T>(T) {
      auto* const grays = reinterpret_cast<T*>(slice_.bytes().data());
      return TakeGray<T>(row, layout_, y, std::span(grays + static_cast<size_t>(y) * nx, nx),
                         blacks_);
    };
    return info_.type == VoxelType::kUint16 ? take(uint16_t{}) : take(uint8_t{});
  }

  std::unique_ptr<PngClient> client_;
  PngLayout layout_;
  SliceBuffer slice_;
  exec::UninitializedVector<std::byte> rows_;
  Blacks blacks_;
};

}  // namespace

bool IsPng(std::string_view front) {
  return front.starts_with(std::string_view("\x89PNG\r\n\x1a\n", 8));
}

absl::StatusOr<std::unique_ptr<ImageSource>> OpenPng(std::shared_ptr<const ImageFile> file,
                                                     const ImageOptions& options) {
  auto client = std::make_unique<PngClient>(std::move(file));
  if (!client->ready()) return absl::ResourceExhaustedError("not enough memory for libpng");
  BCCSKEL_RETURN_IF_ERROR(client->Call("the header cannot be read", [&] {
    png_set_user_limits(client->png(), PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // SizeOfAxes() has ours
    png_set_keep_unknown_chunks(client->png(), PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(client->png(), client->info());
  }));
  ImageInfo info;
  info.format = "PNG";
  const std::array<int64_t, 2> lengths = {png_get_image_width(client->png(), client->info()),
                                          png_get_image_height(client->png(), client->info())};
  BCCSKEL_ASSIGN_OR_RETURN(info.size, SizeOfAxes(lengths, options.limits));
  BCCSKEL_RETURN_IF_ERROR(CheckLength(*client, info.size));
  BCCSKEL_ASSIGN_OR_RETURN(const PngLayout layout, LayoutOf(*client));
  info.type = layout.type;
  return std::make_unique<PngSource>(std::move(client), layout, std::move(info));
}

}  // namespace bccskel
