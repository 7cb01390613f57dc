#include "client/view/packed_numbers.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "absl/strings/escaping.h"
#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

// 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
uint64_t Zigzag(int64_t value) {
  return static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63);
}

std::string DifferencesOf(std::span<const uint32_t> numbers) {
  std::string bytes;
  int64_t before = 0;
  for (const uint32_t number : numbers) {
    uint64_t rest = Zigzag(number - before);
    for (; rest >= 128; rest >>= 7) bytes.push_back(static_cast<char>(rest | 128));
    bytes.push_back(static_cast<char>(rest));
    before = number;
  }
  return bytes;
}

// Texts are compressed in pieces, so that threads can share the work: each piece on its own, but
// with the end of the piece before it as the dictionary. The bytes do not depend on the threads.
constexpr size_t kPiece = size_t{1} << 19;  // about 20 ms
constexpr size_t kDictionary = size_t{1} << 15;

struct Piece {
  int code = Z_OK;  // of zlib
  std::string packed;
  uLong checksum = 0;
};

Bytef* BytesOf(std::string_view text) {
  return reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));  // zlib only reads them
}

Piece DeflatePiece(std::string_view all, size_t begin) {
  const std::string_view bytes = all.substr(begin, kPiece);
  const bool last = begin + bytes.size() == all.size();
  Piece piece;
  z_stream stream = {};
  constexpr int kRaw = -15;  // a window of 32 KiB without a header
  // Level 6 takes half as long again and saves less than 1 %.
  piece.code = deflateInit2(&stream, 5, Z_DEFLATED, kRaw, 8, Z_DEFAULT_STRATEGY);
  if (piece.code != Z_OK) return piece;
  const size_t known = std::min(begin, kDictionary);
  const std::string_view before = all.substr(begin - known, known);
  deflateSetDictionary(&stream, BytesOf(before), static_cast<uInt>(before.size()));
  constexpr uLong kFlush = 16;  // the marker at the end of a piece
  piece.packed.resize(deflateBound(&stream, bytes.size()) + kFlush);
  stream.next_in = BytesOf(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = BytesOf(piece.packed);
  stream.avail_out = static_cast<uInt>(piece.packed.size());
  piece.code = deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
  piece.packed.resize(piece.packed.size() - stream.avail_out);
  deflateEnd(&stream);
  piece.checksum = adler32(adler32(0, nullptr, 0), BytesOf(bytes), static_cast<uInt>(bytes.size()));
  return piece;
}

}  // namespace

absl::StatusOr<std::string> Deflate(std::string_view bytes, const exec::Context& context) {
  std::vector<Piece> pieces(std::max<size_t>(1, (bytes.size() + kPiece - 1) / kPiece));
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(pieces.size(), 1, [&](exec::Share share) {
    pieces[share.begin] = DeflatePiece(bytes, share.begin * kPiece);
  }));
  std::string packed = "\x78\x5e";  // deflate with a window of 32 KiB, a fast level
  uLong checksum = adler32(0, nullptr, 0);
  for (size_t n = 0; n < pieces.size(); ++n) {
    if (pieces[n].code != Z_OK && pieces[n].code != Z_STREAM_END) {
      return absl::ResourceExhaustedError("not enough memory to compress");
    }
    packed += pieces[n].packed;
    const size_t size = bytes.substr(n * kPiece, kPiece).size();
    checksum = adler32_combine(checksum, pieces[n].checksum, static_cast<z_off_t>(size));
    pieces[n] = {};
  }
  for (const int shift : {24, 16, 8, 0}) packed.push_back(static_cast<char>(checksum >> shift));
  return packed;
}

absl::StatusOr<std::string> PackText(std::string_view text, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string packed, Deflate(text, context));
  return absl::Base64Escape(packed);
}

absl::StatusOr<std::string> PackNumbers(std::span<const uint32_t> numbers,
                                        const exec::Context& context) {
  return PackText(DifferencesOf(numbers), context);
}

}  // namespace bccskel::view
