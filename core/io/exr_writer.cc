#include <openexr.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/brick_rows.h"
#include "core/io/exr_context.h"
#include "core/io/exr_header.h"
#include "core/io/volume_writers.h"

namespace bccskel {
namespace {

// Needs: a compression that CheckCompression() takes for OpenEXR.
exr_compression_t ExrCompression(VolumeCompression compression) {
  switch (compression) {
    case VolumeCompression::kRle:
      return EXR_COMPRESSION_RLE;
    case VolumeCompression::kZips:
      return EXR_COMPRESSION_ZIPS;
    case VolumeCompression::kZip:
      return EXR_COMPRESSION_ZIP;
    default:
      return EXR_COMPRESSION_NONE;
  }
}

absl::Status SetGridAttributes(const ExrContext& exr, int part, const Volume& volume) {
  const auto [nx, ny, nz] = volume.extent();
  const auto& [spacing, origin, direction] = volume.placement();
  const exr_attr_v3i_t extent_value = {{{nx, ny, nz}}};
  const exr_attr_v3d_t spacing_value = {{{spacing[0], spacing[1], spacing[2]}}};
  const exr_attr_v3d_t origin_value = {{{origin[0], origin[1], origin[2]}}};
  exr_attr_m33d_t direction_value;
  std::ranges::copy(direction, direction_value.m);
  const exr_context_t to = exr.get();
  for (exr_result_t result :
       {exr_attr_set_int(to, part, kExrProfileAttribute, kExrProfileVersion),
        exr_attr_set_int(to, part, kExrBricksAttribute, static_cast<int>(volume.brick_count())),
        exr_attr_set_v3i(to, part, kExrExtentAttribute, &extent_value),
        exr_attr_set_v3d(to, part, kExrSpacingAttribute, &spacing_value),
        exr_attr_set_v3d(to, part, kExrOriginAttribute, &origin_value),
        exr_attr_set_m33d(to, part, kExrDirectionAttribute, &direction_value)}) {
    BCCSKEL_RETURN_IF_ERROR(exr.Check(result, "attribute"));
  }
  return absl::OkStatus();
}

absl::Status AddPart(const ExrContext& exr, const Volume& volume, const char* name,
                     exr_compression_t compression) {
  int part = 0;
  const LatticeExtent& extent = volume.extent();
  const exr_context_t to = exr.get();
  BCCSKEL_RETURN_IF_ERROR(exr.Check(exr_add_part(to, name, EXR_STORAGE_SCANLINE, &part), "part"));
  BCCSKEL_RETURN_IF_ERROR(exr.Check(
      exr_initialize_required_attr_simple(to, part, extent.nx, extent.ny, compression), "part"));
  for (int32_t channel = 0; channel < ChannelCount(extent); ++channel) {
    const auto added = exr_add_channel(to, part, ExrChannelName(channel).c_str(), EXR_PIXEL_UINT,
                                       EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    BCCSKEL_RETURN_IF_ERROR(exr.Check(added, "channel"));
  }
  return SetGridAttributes(exr, part, volume);
}

// Compresses and writes the chunks of one part in order.
class ExrPartWriter {
 public:
  ExrPartWriter(const ExrContext& exr, const Volume& volume, const BrickRows& rows,
                Sublattice sublattice, VolumeCompression compression)
      : exr_(exr),
        extent_(volume.extent()),
        rows_(rows),
        sublattice_(sublattice),
        part_(static_cast<int>(sublattice)),
        lines_per_chunk_(ExrLinesPerChunk(compression)),
        line_words_(ExrLineBytes(extent_) / sizeof(uint32_t)),
        // A chunk of one line still needs the whole brick row that the line belongs to.
        words_(static_cast<size_t>(std::max(lines_per_chunk_, 4)) * line_words_) {}
  ExrPartWriter(const ExrPartWriter&) = delete;
  ExrPartWriter& operator=(const ExrPartWriter&) = delete;
  ~ExrPartWriter() { exr_encoding_destroy(exr_.get(), &pipeline_); }

  absl::Status Write(const exec::Context& context) {
    const int32_t lines_at_once = std::max(lines_per_chunk_, 4);
    for (int32_t y = 0; y < extent_.ny; y += lines_at_once) {
      if (context.ShouldStop()) return context.StopStatus();
      const int32_t end = std::min(y + lines_at_once, extent_.ny);
      FillStrip(y, end);
      for (int32_t first = y; first < end; first += lines_per_chunk_) {
        BCCSKEL_RETURN_IF_ERROR(exr_.Check(WriteChunk(first, first - y), "chunk"));
      }
    }
    return absl::OkStatus();
  }

 private:
  void FillStrip(int32_t begin, int32_t end) {
    for (int32_t y = begin; y < end; y += 4) {
      for (int32_t channel = 0; channel < ChannelCount(extent_); ++channel) {
        uint32_t* first = &words_[WordAt(y - begin, channel)];
        rows_.Fill({sublattice_, y / 4, channel},
                   {first, line_words_, RowsInBrickRow(extent_, y / 4)});
      }
    }
  }

  size_t WordAt(int32_t line_of_strip, int32_t channel) const {
    return static_cast<size_t>(line_of_strip) * line_words_ +
           static_cast<size_t>(channel) * static_cast<size_t>(extent_.nx);
  }

  exr_result_t WriteChunk(int32_t y, int32_t line_of_strip) {
    exr_chunk_info_t chunk = {};
    exr_result_t result = exr_write_scanline_chunk_info(exr_.get(), part_, y, &chunk);
    if (result == EXR_ERR_SUCCESS) result = Prepare(chunk);
    if (result != EXR_ERR_SUCCESS) return result;
    for (int32_t channel = 0; channel < pipeline_.channel_count; ++channel) {
      exr_coding_channel_info_t& info = pipeline_.channels[channel];
      info.user_pixel_stride = sizeof(uint32_t);
      info.user_line_stride = static_cast<int32_t>(line_words_ * sizeof(uint32_t));
      info.encode_from_ptr =
          reinterpret_cast<const uint8_t*>(&words_[WordAt(line_of_strip, channel)]);
    }
    if (!routines_chosen_) {
      result = exr_encoding_choose_default_routines(exr_.get(), part_, &pipeline_);
      routines_chosen_ = true;
    }
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(exr_.get(), part_, &pipeline_) : result;
  }

  exr_result_t Prepare(const exr_chunk_info_t& chunk) {
    if (pipeline_.context == nullptr) {
      return exr_encoding_initialize(exr_.get(), part_, &chunk, &pipeline_);
    }
    return exr_encoding_update(exr_.get(), part_, &chunk, &pipeline_);
  }

  const ExrContext& exr_;
  LatticeExtent extent_;
  const BrickRows& rows_;
  Sublattice sublattice_;
  int part_;
  int32_t lines_per_chunk_;
  size_t line_words_;
  std::vector<uint32_t> words_;
  exr_encode_pipeline_t pipeline_ = EXR_ENCODE_PIPELINE_INITIALIZER;
  bool routines_chosen_ = false;
};

absl::Status CheckBrickCount(const Volume& volume) {
  constexpr size_t kMost = std::numeric_limits<int32_t>::max();
  if (volume.brick_count() <= kMost) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "%d bricks: an OpenEXR volume declares at most %d", volume.brick_count(), kMost));
}

}  // namespace

absl::Status WriteExr(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                      const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckBrickCount(volume));
  BCCSKEL_RETURN_IF_ERROR(CheckExrCanHold(volume.extent(), compression));
  ExrContext exr;
  BCCSKEL_RETURN_IF_ERROR(exr.OpenForWriting(sink));
  for (const char* name : kExrPartNames) {
    BCCSKEL_RETURN_IF_ERROR(AddPart(exr, volume, name, ExrCompression(compression)));
  }
  BCCSKEL_RETURN_IF_ERROR(exr.Check(exr_write_header(exr.get()), "header"));
  const BrickRows rows(volume);
  for (Sublattice sublattice : kSublattices) {
    BCCSKEL_RETURN_IF_ERROR(
        ExrPartWriter(exr, volume, rows, sublattice, compression).Write(context));
  }
  return exr.Finish();
}

}  // namespace bccskel
