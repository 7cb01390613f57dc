#ifndef BCCSKEL_TESTS_SUPPORT_DEFLATED_H_
#define BCCSKEL_TESTS_SUPPORT_DEFLATED_H_

#include <zlib.h>

#include <cstdlib>
#include <string>

namespace bccskel::testing {

enum class Wrapping { kZlib, kGzip };

inline std::string Deflated(const std::string& bytes, Wrapping wrapping = Wrapping::kZlib) {
  z_stream zlib = {};
  const int window = wrapping == Wrapping::kGzip ? 15 + 16 : 15;
  if (deflateInit2(&zlib, 9, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY) != Z_OK) std::abort();
  std::string packed(deflateBound(&zlib, bytes.size()) + 64, '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  zlib.avail_in = static_cast<uInt>(bytes.size());
  zlib.next_out = reinterpret_cast<Bytef*>(packed.data());
  zlib.avail_out = static_cast<uInt>(packed.size());
  if (deflate(&zlib, Z_FINISH) != Z_STREAM_END) std::abort();
  packed.resize(zlib.total_out);
  deflateEnd(&zlib);
  return packed;
}

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_SUPPORT_DEFLATED_H_
