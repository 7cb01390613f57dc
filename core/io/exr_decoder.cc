#include <openexr.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/brick_collector.h"
#include "core/io/exr_context.h"
#include "core/io/exr_header.h"
#include "core/io/plane_rows.h"
#include "core/io/volume_decoders.h"

namespace bccskel {
namespace {

// What OpenEXR takes for the headers of both parts, at most: their attributes and 1400 channels.
constexpr uint64_t kHeaderBudgetBytes = uint64_t{4} << 20;

// Decompresses the chunks of one part in order.
class ExrPartChunks {
 public:
  ExrPartChunks(const ExrContext& context, int part) : context_(context), part_(part) {}
  ExrPartChunks(const ExrPartChunks&) = delete;
  ExrPartChunks& operator=(const ExrPartChunks&) = delete;
  ~ExrPartChunks() { exr_decoding_destroy(context_.get(), &pipeline_); }

  // The scan lines of the chunk that begins at line `y`, each with all channels one after another.
  // They live until the next call.
  absl::StatusOr<std::span<const std::byte>> Decode(int32_t y) {
    exr_chunk_info_t chunk = {};
    const auto info = exr_read_scanline_chunk_info(context_.get(), part_, y, &chunk);
    BCCSKEL_RETURN_IF_ERROR(context_.Check(info, "chunk"));
    BCCSKEL_RETURN_IF_ERROR(context_.Check(Prepare(chunk), "chunk"));
    BCCSKEL_RETURN_IF_ERROR(
        context_.Check(exr_decoding_run(context_.get(), part_, &pipeline_), "chunk data"));
    return std::span(static_cast<const std::byte*>(pipeline_.unpacked_buffer),
                     static_cast<size_t>(chunk.unpacked_size));
  }

 private:
  exr_result_t Prepare(const exr_chunk_info_t& chunk) {
    const exr_context_t from = context_.get();
    if (pipeline_.context != nullptr) return exr_decoding_update(from, part_, &chunk, &pipeline_);
    exr_result_t result = exr_decoding_initialize(from, part_, &chunk, &pipeline_);
    if (result != EXR_ERR_SUCCESS) return result;
    result = exr_decoding_choose_default_routines(from, part_, &pipeline_);
    // Without a routine for unpacking the lines stay as stored, which is what we want.
    pipeline_.unpack_and_convert_fn = nullptr;
    return result;
  }

  const ExrContext& context_;
  int part_;
  exr_decode_pipeline_t pipeline_ = EXR_DECODE_PIPELINE_INITIALIZER;
};

// Collects lines until a brick row is complete.
class LineStrip {
 public:
  LineStrip(const LatticeExtent& extent, Sublattice sublattice, BrickCollector& collector)
      : extent_(extent),
        sublattice_(sublattice),
        collector_(collector),
        line_words_(ExrLineBytes(extent) / sizeof(uint32_t)),
        words_(4 * line_words_) {}

  absl::Status Add(std::span<const std::byte> line) {
    std::memcpy(&words_[lines_ * line_words_], line.data(), line.size());
    ++lines_;
    return lines_ == RowsInBrickRow(extent_, by_) ? Flush() : absl::OkStatus();
  }

 private:
  absl::Status Flush() {
    for (int32_t channel = 0; channel < ChannelCount(extent_); ++channel) {
      const uint32_t* first =
          &words_[static_cast<size_t>(channel) * static_cast<size_t>(extent_.nx)];
      BCCSKEL_RETURN_IF_ERROR(
          collector_.AddRows({sublattice_, by_, channel}, {first, line_words_, lines_}));
    }
    ++by_;
    lines_ = 0;
    return absl::OkStatus();
  }

  LatticeExtent extent_;
  Sublattice sublattice_;
  BrickCollector& collector_;
  size_t line_words_;
  std::vector<uint32_t> words_;
  int32_t by_ = 0;
  size_t lines_ = 0;
};

absl::Status ReadPart(const ExrContext& exr, const VolumeHeader& header, Sublattice sublattice,
                      BrickCollector& collector, const exec::Context& context) {
  ExrPartChunks chunks(exr, static_cast<int>(sublattice));
  LineStrip strip(header.extent, sublattice, collector);
  const size_t line_bytes = ExrLineBytes(header.extent);
  const int32_t lines = ExrLinesPerChunk(header.compression);
  for (int32_t y = 0; y < header.extent.ny; y += lines) {
    if (context.ShouldStop()) return context.StopStatus();
    BCCSKEL_ASSIGN_OR_RETURN(std::span<const std::byte> decoded, chunks.Decode(y));
    const auto wanted = static_cast<size_t>(std::min(lines, header.extent.ny - y)) * line_bytes;
    if (decoded.size() != wanted) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "OpenEXR chunk at line %d decodes to %d bytes, must be %d", y, decoded.size(), wanted));
    }
    for (size_t at = 0; at < wanted; at += line_bytes) {
      BCCSKEL_RETURN_IF_ERROR(strip.Add(decoded.subspan(at, line_bytes)));
    }
  }
  return absl::OkStatus();
}

uint64_t OpenExrBudget(const VolumeHeader& header) {
  return kHeaderBudgetBytes + header.strip_bytes;
}

// Reads a whole volume, chunk by chunk, straight into bricks.
absl::StatusOr<Volume> ReadExr(std::span<const std::byte> file, const VolumeLimits& limits,
                               const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const ExrHeader header, ScanExrHeader(file, limits));
  BCCSKEL_RETURN_IF_ERROR(CheckExrChunks(file, header));
  ExrContext exr;
  BCCSKEL_RETURN_IF_ERROR(exr.OpenForReading(file, OpenExrBudget(header.volume)));
  BrickCollector collector(header.volume);
  for (Sublattice sublattice : kSublattices) {
    BCCSKEL_RETURN_IF_ERROR(ReadPart(exr, header.volume, sublattice, collector, context));
  }
  return std::move(collector).Build();
}

class ExrDecoder final : public VolumeDecoder {
 public:
  ExrDecoder(const VolumeHeader& header, const VolumeLimits& limits)
      : header_(header), limits_(limits) {}

  absl::Status Append(std::span<const std::byte> bytes) override {
    if (bytes.size() > header_.max_encoded_bytes - file_.size()) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "more than %d bytes for an OpenEXR volume of %d x %d x %d cells",
          header_.max_encoded_bytes, header_.extent.nx, header_.extent.ny, header_.extent.nz));
    }
    file_.insert(file_.end(), bytes.begin(), bytes.end());
    return absl::OkStatus();
  }

  absl::StatusOr<Volume> Finish(const exec::Context& context) override {
    BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader found,
                             ScanVolumeHeader(VolumeEncoding::kOpenExr, file_, limits_));
    if (found != header_) {
      return absl::InvalidArgumentError(
          "the OpenEXR bytes have another header than the one announced");
    }
    return ReadExr(file_, limits_, context);
  }

 private:
  const VolumeHeader header_;
  const VolumeLimits limits_;
  std::vector<std::byte> file_;
};

}  // namespace

std::unique_ptr<VolumeDecoder> MakeExrDecoder(const VolumeHeader& header,
                                              const VolumeLimits& limits) {
  return std::make_unique<ExrDecoder>(header, limits);
}

}  // namespace bccskel
