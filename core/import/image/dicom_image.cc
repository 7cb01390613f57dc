#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/dicom_header.h"
#include "core/import/image/dicom_stack.h"
#include "core/import/image/image_readers.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {
namespace {

using Headers = std::vector<DicomHeader>;

absl::Status InFile(const std::string& path, const absl::Status& status) {
  const std::string name = std::filesystem::path(path).filename().string();
  return absl::Status(status.code(), absl::StrFormat("'%s': %s", name, status.message()));
}

// Runs what calls DCMTK; its exceptions become statuses.
template <typename Call>
absl::Status Guarded(const std::string& path, Call call) {
  try {
    const absl::Status status = call();
    return status.ok() ? status : InFile(path, status);
  } catch (const std::bad_alloc&) {
    return InFile(path, absl::ResourceExhaustedError("not enough memory"));
  } catch (const std::exception& error) {
    return InFile(path, absl::InvalidArgumentError(std::string("damaged: ") + error.what()));
  }
}

// The expanded voxels of one file; values are those of the file, before rescaling.
struct DicomVoxels {
  std::vector<char> bytes;
  VoxelType type = VoxelType::kUint8;
  double slope = 1;
  double intercept = 0;
};

absl::StatusOr<VoxelType> TypeOf(DcmDataset& data) {
  Uint16 bits = 0, is_signed = 0;
  data.findAndGetUint16(DCM_BitsAllocated, bits);
  data.findAndGetUint16(DCM_PixelRepresentation, is_signed);
  switch (bits) {
    case 8:
      return is_signed == 0 ? VoxelType::kUint8 : VoxelType::kInt8;
    case 16:
      return is_signed == 0 ? VoxelType::kUint16 : VoxelType::kInt16;
    case 32:
      return is_signed == 0 ? VoxelType::kUint32 : VoxelType::kInt32;
    default:
      return absl::UnimplementedError(absl::StrFormat("voxels of %d bits are not supported", bits));
  }
}

absl::StatusOr<double> NumberOf(DcmDataset& data, const DcmTagKey& tag, double without) {
  Float64 number = without;
  if (data.tagExistsWithValue(tag) && data.findAndGetFloat64(tag, number).bad()) {
    return absl::InvalidArgumentError("RescaleSlope or RescaleIntercept is not a number");
  }
  if (std::isfinite(number)) return number;
  return absl::InvalidArgumentError("RescaleSlope or RescaleIntercept is not finite");
}

// The file with its voxels not compressed.
absl::Status LoadExpanded(const std::string& path, DcmFileFormat& file) {
  [[maybe_unused]] static const bool registered = [] {
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
    DcmRLEDecoderRegistration::registerCodecs();
    return true;
  }();
  if (const OFCondition loaded = file.loadFile(path.c_str()); loaded.bad()) {
    return absl::InvalidArgumentError(std::string("the file is damaged: ") + loaded.text());
  }
  const DcmXfer stored(file.getDataset()->getOriginalXfer());
  const OFCondition expanded =
      file.getDataset()->chooseRepresentation(EXS_LittleEndianExplicit, nullptr);
  if (expanded.good()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "its voxels (%s) cannot be expanded: %s; `gdcmconv --raw` of GDCM writes files without "
      "compression",
      stored.getXferName(), expanded.text()));
}

// The first `needed` bytes of voxels.
absl::StatusOr<std::vector<char>> PixelData(DcmDataset& data, uint64_t needed) {
  const Uint8* bytes = nullptr;
  const Uint16* words = nullptr;
  unsigned long count = 0;  // NOLINT(google-runtime-int): DCMTK's
  const char* from = nullptr;
  uint64_t found = 0;
  if (data.findAndGetUint8Array(DCM_PixelData, bytes, &count).good() && bytes != nullptr) {
    from = reinterpret_cast<const char*>(bytes);
    found = count;
  } else if (data.findAndGetUint16Array(DCM_PixelData, words, &count).good() && words != nullptr) {
    from = reinterpret_cast<const char*>(words);
    found = 2 * uint64_t{count};
  }
  if (found < needed) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d bytes of voxels are needed, the file holds %d", needed, found));
  }
  return std::vector<char>(from, from + needed);
}

uint64_t VoxelCount(const DicomHeader& header) {
  const DicomFrame& frame = header.frames.front();
  return static_cast<uint64_t>(frame.rows) * static_cast<uint64_t>(frame.columns) *
         header.frames.size();
}

absl::StatusOr<DicomVoxels> ExpandVoxels(const DicomHeader& header) {
  DcmFileFormat file;
  BCCSKEL_RETURN_IF_ERROR(LoadExpanded(header.path, file));
  DcmDataset& data = *file.getDataset();
  DicomVoxels voxels;
  BCCSKEL_ASSIGN_OR_RETURN(voxels.type, TypeOf(data));
  BCCSKEL_ASSIGN_OR_RETURN(voxels.slope, NumberOf(data, DCM_RescaleSlope, 1));
  BCCSKEL_ASSIGN_OR_RETURN(voxels.intercept, NumberOf(data, DCM_RescaleIntercept, 0));
  BCCSKEL_ASSIGN_OR_RETURN(voxels.bytes,
                           PixelData(data, VoxelCount(header) * VoxelBytes(voxels.type)));
  return voxels;
}

// The bits of a segmentation: those of all frames one after the other, the lowest of a byte first.
absl::StatusOr<DicomVoxels> ReadBits(const DicomHeader& header) {
  DcmFileFormat file;
  BCCSKEL_RETURN_IF_ERROR(LoadExpanded(header.path, file));
  DicomVoxels voxels;
  BCCSKEL_ASSIGN_OR_RETURN(voxels.bytes,
                           PixelData(*file.getDataset(), (VoxelCount(header) + 7) / 8));
  return voxels;
}

class DicomSource : public ImageSource {
 public:
  DicomSource(Headers files, DicomStack stack)
      : ImageSource({.format = "",
                     .size = stack.size,
                     .placement = stack.placement,
                     .unit = "mm",
                     .world = "LPS"}),
        files_(std::move(files)),
        slices_(std::move(stack.slices)) {}

 protected:
  virtual absl::StatusOr<SliceValues> ValuesOf(const std::vector<DicomFrame>& frames) = 0;

  size_t SliceVoxels() const { return static_cast<size_t>(info_.size.SliceVoxels()); }
  // Keeps the voxels of the last file only: a series has a file for each slice.
  template <typename Read>
  absl::StatusOr<const DicomVoxels*> VoxelsOf(size_t file, Read read) {
    if (file_ != file) {
      file_.reset();
      BCCSKEL_RETURN_IF_ERROR(Guarded(files_[file].path, [&]() -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(voxels_, read(files_[file]));
        return absl::OkStatus();
      }));
      file_ = file;
    }
    return &voxels_;
  }

 private:
  absl::StatusOr<SliceValues> ReadSlice(int32_t z) final {
    return ValuesOf(slices_[static_cast<size_t>(z)]);
  }

  Headers files_;
  std::vector<std::vector<DicomFrame>> slices_;
  DicomVoxels voxels_;
  std::optional<size_t> file_;
};

// Values; rescaled ones are doubles, as those of NIfTI.
class DicomValues final : public DicomSource {
 public:
  using DicomSource::DicomSource;

  // Of the first slice, whose file says what type the values have.
  absl::Status Begin(size_t file) {
    info_.format = "DICOM";
    BCCSKEL_ASSIGN_OR_RETURN(const DicomVoxels* voxels, VoxelsOf(file, ExpandVoxels));
    info_.type = IsPlain(*voxels) ? voxels->type : VoxelType::kFloat64;
    return absl::OkStatus();
  }

 private:
  static bool IsPlain(const DicomVoxels& voxels) {
    return voxels.slope == 1 && voxels.intercept == 0;
  }

  absl::StatusOr<SliceValues> ValuesOf(const std::vector<DicomFrame>& frames) override {
    const DicomFrame& frame = frames.front();
    BCCSKEL_ASSIGN_OR_RETURN(const DicomVoxels* voxels, VoxelsOf(frame.file, ExpandVoxels));
    buffer_.Resize(voxels->type, SliceVoxels());
    const std::span<std::byte> bytes = buffer_.bytes();
    std::memcpy(bytes.data(), voxels->bytes.data() + frame.index * bytes.size(), bytes.size());
    if (info_.type == VoxelType::kFloat64) return buffer_.Scaled(voxels->slope, voxels->intercept);
    if (IsPlain(*voxels) && voxels->type == info_.type) return buffer_.values();
    return absl::InvalidArgumentError(absl::StrFormat(
        "'%s' has voxels of another type or scale than the first slice", frame.name));
  }

  SliceBuffer buffer_;
};

// Segment numbers.
class DicomSegments final : public DicomSource {
 public:
  DicomSegments(Headers files, DicomStack stack) : DicomSource(std::move(files), std::move(stack)) {
    info_.format = "DICOM segmentation";
    info_.type = VoxelType::kUint16;
  }

 private:
  absl::StatusOr<SliceValues> ValuesOf(const std::vector<DicomFrame>& frames) override {
    labels_.assign(SliceVoxels(), 0);
    for (const DicomFrame& frame : frames) {
      BCCSKEL_ASSIGN_OR_RETURN(const DicomVoxels* voxels, VoxelsOf(frame.file, ReadBits));
      BCCSKEL_RETURN_IF_ERROR(AddFrame(*voxels, frame));
    }
    return SliceValues(std::span<const uint16_t>(labels_));
  }

  absl::Status AddFrame(const DicomVoxels& voxels, const DicomFrame& frame) {
    const auto label = static_cast<uint16_t>(frame.segment);
    size_t bit = frame.index * SliceVoxels();
    for (uint16_t& value : labels_) {
      const bool inside = (voxels.bytes[bit / 8] >> (bit % 8) & 1) != 0;
      ++bit;
      if (!inside) continue;
      if (value != 0 && value != label) {
        return absl::InvalidArgumentError(
            absl::StrFormat("segments %d and %d overlap; choose one with --channel", value, label));
      }
      value = label;
    }
    return absl::OkStatus();
  }

  std::vector<uint16_t> labels_;
};

// All frames of the files, or those of one segment.
absl::StatusOr<std::vector<DicomFrame>> FramesOf(const Headers& files,
                                                 const std::optional<int64_t>& segment) {
  std::vector<DicomFrame> frames;
  for (size_t file = 0; file < files.size(); ++file) {
    if (files[file].kind != files.front().kind) {
      return absl::InvalidArgumentError("the series holds images and segmentations");
    }
    for (DicomFrame frame : files[file].frames) {
      frame.file = file;
      if (!segment.has_value() || *segment == int64_t{frame.segment}) frames.push_back(frame);
    }
  }
  if (!frames.empty()) return frames;
  return absl::InvalidArgumentError(absl::StrFormat("there is no segment %d", *segment));
}

}  // namespace

absl::StatusOr<std::unique_ptr<ImageSource>> OpenDicom(const std::string& path,
                                                       const ImageOptions& options) {
  if (options.time.has_value() || options.level.has_value()) {
    return absl::InvalidArgumentError("--time and --level do not apply to DICOM");
  }
  BCCSKEL_ASSIGN_OR_RETURN(Headers files, DicomFilesOf(path, options));
  const bool segments = files.front().kind == DicomKind::kSegmentation;
  if (options.channel.has_value() && !segments) {
    return absl::InvalidArgumentError("--channel applies only to segmentations of DICOM");
  }
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<DicomFrame> frames, FramesOf(files, options.channel));
  BCCSKEL_ASSIGN_OR_RETURN(
      DicomStack stack,
      StackFrames(std::move(frames), segments ? DicomGaps::kEmpty : DicomGaps::kRefused,
                  options.limits));
  if (segments) return std::make_unique<DicomSegments>(std::move(files), std::move(stack));
  const size_t first = stack.slices.front().front().file;
  auto source = std::make_unique<DicomValues>(std::move(files), std::move(stack));
  BCCSKEL_RETURN_IF_ERROR(source->Begin(first));
  return source;
}

}  // namespace bccskel
