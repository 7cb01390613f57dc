#ifndef BCCSKEL_TESTS_CORE_IO_HANDMADE_EXR_H_
#define BCCSKEL_TESTS_CORE_IO_HANDMADE_EXR_H_

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel {

// Little-endian bytes of numbers, written from the format's description and not with the codec.
template <typename Number>
std::string Bytes(Number number) {
  std::string bytes(sizeof(Number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(Number));
  if constexpr (std::endian::native == std::endian::big) bytes = {bytes.rbegin(), bytes.rend()};
  return bytes;
}

template <typename Number, typename... Rest>
std::string Bytes(Number first, Number second, Rest... rest) {
  return Bytes<Number>(first) + Bytes<Number>(second, static_cast<Number>(rest)...);
}

// An uncompressed OpenEXR volume file, put together byte by byte as the format's documents say, so
// that tests do not judge the codec by itself. Every piece can be bent before Build().
struct HandmadeExr {
  struct Attribute {
    std::string name, type, value;
  };
  using Part = std::vector<Attribute>;

  explicit HandmadeExr(LatticeExtent size) : extent(size) {
    for (const char* name : {"even", "odd"}) parts.push_back(StandardPart(size, name));
  }

  int32_t channels() const { return (extent.nz + 31) / 32; }

  static std::string ChannelList(int32_t count) {
    std::string list;
    for (int32_t n = 0; n < count; ++n) {
      const std::string digits = std::to_string(10'000 + n);  // the last four of five
      list.append(1, 'z').append(digits, 1, 4).append(1, '\0');
      list += Bytes<int32_t>(0, 0, 1, 1);  // UINT, not linear + reserved, sampling
    }
    list.push_back('\0');
    return list;
  }

  static Part StandardPart(LatticeExtent size, const std::string& name) {
    return {
        {"channels", "chlist", ChannelList((size.nz + 31) / 32)},
        {"compression", "compression", std::string(1, '\0')},
        {"dataWindow", "box2i", Bytes<int32_t>(0, 0, size.nx - 1, size.ny - 1)},
        {"displayWindow", "box2i", Bytes<int32_t>(0, 0, size.nx - 1, size.ny - 1)},
        {"lineOrder", "lineOrder", std::string(1, '\0')},
        {"pixelAspectRatio", "float", Bytes<float>(1)},
        {"screenWindowCenter", "v2f", Bytes<float>(0, 0)},
        {"screenWindowWidth", "float", Bytes<float>(1)},
        {"name", "string", name},
        {"type", "string", "scanlineimage"},
        {"chunkCount", "int", Bytes<int32_t>(size.ny)},
        {"bccProfile", "int", Bytes<int32_t>(1)},
        {"bccExtent", "v3i", Bytes<int32_t>(size.nx, size.ny, size.nz)},
        {"bccSpacing", "v3d", Bytes<double>(1, 1, 1)},
        {"bccOrigin", "v3d", Bytes<double>(0, 0, 0)},
        {"bccDirection", "m33d", Bytes<double>(1, 0, 0, 0, 1, 0, 0, 0, 1)},
    };
  }

  void SetPoint(int part, int32_t i, int32_t j, int32_t k) {
    words[{part, k / 32, j, i}] |= uint32_t{1} << (k % 32);
  }

  // The attribute of both parts.
  void Set(std::string_view name, const std::string& value) {
    for (Part& part : parts) Find(part, name).value = value;
  }
  void SetType(std::string_view name, const std::string& type) {
    for (Part& part : parts) Find(part, name).type = type;
  }
  void Rename(std::string_view name, const std::string& to) {
    for (Part& part : parts) Find(part, name).name = to;
  }
  void Add(const Attribute& attribute) {
    for (Part& part : parts) part.push_back(attribute);
  }
  static Attribute& Find(Part& part, std::string_view name) {
    for (Attribute& attribute : part) {
      if (attribute.name == name) return attribute;
    }
    std::abort();
  }

  std::string Header() const {
    std::string bytes = Bytes<uint32_t>(magic, version);
    for (const Part& part : parts) {
      for (const auto& [name, type, value] : part) {
        bytes.append(name).append(1, '\0').append(type).append(1, '\0');
        bytes.append(Bytes(static_cast<int32_t>(value.size()))).append(value);
      }
      bytes.push_back('\0');
    }
    bytes.push_back('\0');
    return bytes;
  }

  std::string Build() const {
    std::string tables = Header(), chunks;
    const size_t tables_end = tables.size() + 8 * parts.size() * static_cast<size_t>(extent.ny);
    for (int32_t part = 0; part < static_cast<int32_t>(parts.size()); ++part) {
      for (int32_t y = 0; y < extent.ny; ++y) {
        tables += Bytes<uint64_t>(tables_end + chunks.size());
        chunks += Bytes<int32_t>(part, y, 4 * extent.nx * channels());
        for (int32_t c = 0; c < channels(); ++c) {
          for (int32_t x = 0; x < extent.nx; ++x) {
            const auto word = words.find({part, c, y, x});
            chunks += Bytes(word == words.end() ? uint32_t{0} : word->second);
          }
        }
      }
    }
    return tables + chunks;
  }

  LatticeExtent extent;
  uint32_t magic = 20000630;
  uint32_t version = 0x1002;
  std::vector<Part> parts;
  std::map<std::array<int32_t, 4>, uint32_t> words;  // by part, channel, y, x; others are 0
};

}  // namespace bccskel

#endif  // BCCSKEL_TESTS_CORE_IO_HANDMADE_EXR_H_
