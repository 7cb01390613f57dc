#include "core/import/mesh/vtp_array.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/xml_document.h"

namespace bccskel {
namespace {

absl::StatusOr<Scalar> VtpTypeOf(std::string_view name) {
  if (const std::optional<Scalar> type = ScalarNamed(name); type) return *type;
  return absl::InvalidArgumentError(
      absl::StrFormat("VTP: '%s' is no type of numbers such as Float32 or Int64", name));
}

absl::Status BadVtpAttribute(const char* what, std::string_view found, std::string_view known) {
  return absl::InvalidArgumentError(
      absl::StrFormat("VTP: %s '%s' is not read, only %s", what, found.substr(0, 40), known));
}

}  // namespace

absl::StatusOr<VtpArrayReader> VtpArrayReader::Make(const pugi::xml_node& file,
                                                    std::string_view appended,
                                                    uint64_t max_expanded) {
  VtpArrayReader reader;
  reader.appended_ = appended;
  reader.appended_left_ = appended.size();
  reader.expanded_left_ = max_expanded;
  const std::string_view order = XmlAttribute(file, "byte_order");
  if (order == "BigEndian") {
    reader.order_ = std::endian::big;
  } else if (!order.empty() && order != "LittleEndian") {
    return BadVtpAttribute("byte_order", order, "LittleEndian and BigEndian");
  }
  const std::string_view header = XmlAttribute(file, "header_type");
  if (header == "UInt64") {
    reader.header_ = Scalar::kUint64;
  } else if (!header.empty() && header != "UInt32") {
    return BadVtpAttribute("header_type", header, "UInt32 and UInt64");
  }
  const std::string_view compressor = XmlAttribute(file, "compressor");
  if (compressor == "vtkZLibDataCompressor") {
    reader.compressor_ = Compressor::kZlib;
  } else if (!compressor.empty()) {
    return BadVtpAttribute("compressor", compressor,
                           "vtkZLibDataCompressor; save the file with it");
  }
  const std::string_view encoding = XmlAttribute(file.child("AppendedData"), "encoding");
  if (encoding == "base64") {
    reader.appended_encoding_ = StoredBytes::Encoding::kBase64;
  } else if (!encoding.empty() && encoding != "raw") {
    return BadVtpAttribute("encoding of <AppendedData>", encoding, "raw and base64");
  }
  return reader;
}

absl::StatusOr<DataArray> VtpArrayReader::Read(const pugi::xml_node& array) {
  BCCSKEL_ASSIGN_OR_RETURN(const Scalar type, VtpTypeOf(XmlAttribute(array, "type")));
  const std::string_view format = XmlAttribute(array, "format");
  if (format.empty() || format == "ascii") return DataArray::FromText("VTP", array.child_value());
  BCCSKEL_ASSIGN_OR_RETURN(StoredBytes stored, Stored(array));
  const size_t before = stored.left();
  BCCSKEL_ASSIGN_OR_RETURN(
      std::string bytes, compressor_ == Compressor::kNone ? TakePlain(stored) : TakeBlocks(stored));
  if (format == "appended") BCCSKEL_RETURN_IF_ERROR(ChargeAppended(before - stored.left()));
  if (bytes.size() % ScalarBytes(type) == 0) return DataArray(std::move(bytes), type, order_);
  return absl::InvalidArgumentError(
      absl::StrFormat("VTP: an array of %d bytes is no whole number of values of %d bytes",
                      bytes.size(), ScalarBytes(type)));
}

absl::StatusOr<StoredBytes> VtpArrayReader::Stored(const pugi::xml_node& array) const {
  const std::string_view format = XmlAttribute(array, "format");
  if (format == "binary") return StoredBytes(array.child_value(), StoredBytes::Encoding::kBase64);
  if (format != "appended") {
    return BadVtpAttribute("format", format, "ascii, binary and appended");
  }
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t offset, XmlCount("VTP", array, "offset"));
  if (offset <= appended_.size()) return StoredBytes(appended_.substr(offset), appended_encoding_);
  return absl::InvalidArgumentError(absl::StrFormat(
      "VTP: an array begins at byte %d of %d bytes of <AppendedData>", offset, appended_.size()));
}

absl::StatusOr<uint64_t> VtpArrayReader::TakeWord(StoredBytes& stored) const {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string word, stored.Take(ScalarBytes(header_)));
  const double value = ScalarAt(word.data(), header_, order_);
  constexpr double kMost = 9007199254740992;  // 2^53, from where doubles are no longer exact
  if (value < kMost) return static_cast<uint64_t>(value);
  return absl::InvalidArgumentError(absl::StrFormat("VTP: an array declares %g bytes", value));
}

absl::StatusOr<std::string> VtpArrayReader::TakePlain(StoredBytes& stored) const {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t size, TakeWord(stored));
  return stored.Take(size);
}

// The header: blocks, bytes of a block, bytes of the last one (0: it is full), then the stored
// bytes of each block. An empty array may stop behind its 0 blocks.
absl::StatusOr<std::string> VtpArrayReader::TakeBlocks(StoredBytes& stored) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t blocks, TakeWord(stored));
  if (blocks == 0) return std::string();
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t full, TakeWord(stored));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t last, TakeWord(stored));
  std::vector<uint64_t> sizes;
  for (uint64_t n = 0; n < blocks; ++n) {
    BCCSKEL_ASSIGN_OR_RETURN(sizes.emplace_back(), TakeWord(stored));
  }
  std::string bytes;
  for (uint64_t n = 0; n < blocks; ++n) {
    const uint64_t size = n + 1 == blocks && last > 0 ? last : full;
    if (size > expanded_left_) {
      return absl::ResourceExhaustedError(
          "VTP: the arrays expand to more than the limit of a file");
    }
    expanded_left_ -= size;
    BCCSKEL_ASSIGN_OR_RETURN(const std::string block, stored.Take(sizes[n]));
    BCCSKEL_ASSIGN_OR_RETURN(const std::string plain, Inflate(block, size));
    bytes += plain;
  }
  return bytes;
}

// Arrays that share their bytes would let a small file fill a large memory.
absl::Status VtpArrayReader::ChargeAppended(uint64_t bytes) {
  if (bytes > appended_left_) {
    return absl::InvalidArgumentError(
        "VTP: arrays overlap in <AppendedData>: together they take more bytes than it has");
  }
  appended_left_ -= bytes;
  return absl::OkStatus();
}

}  // namespace bccskel
