#ifndef BCCSKEL_CORE_IO_LITTLE_ENDIAN_H_
#define BCCSKEL_CORE_IO_LITTLE_ENDIAN_H_

#include <bit>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

namespace bccskel {

// Every encoding of a volume is little-endian, and so is every machine that bccskel runs on; the
// codecs copy numbers as they lie in memory.
static_assert(std::endian::native == std::endian::little);

// The number at `offset`. Needs: offset + sizeof(Number) <= bytes.size().
template <typename Number>
Number LoadNumber(std::span<const std::byte> bytes, size_t offset) {
  static_assert(std::is_arithmetic_v<Number>);
  Number number;
  std::memcpy(&number, bytes.data() + offset, sizeof(Number));
  return number;
}

template <typename Number>
void StoreNumber(Number number, std::span<std::byte> bytes, size_t offset) {
  static_assert(std::is_arithmetic_v<Number>);
  std::memcpy(bytes.data() + offset, &number, sizeof(Number));
}

// Reads untrusted bytes; a value beyond the end is nullopt.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  size_t position() const { return position_; }
  bool at_end() const { return position_ == bytes_.size(); }

  std::optional<std::span<const std::byte>> Take(size_t count) {
    if (count > bytes_.size() - position_) return std::nullopt;
    const auto taken = bytes_.subspan(position_, count);
    position_ += count;
    return taken;
  }

  template <typename Number>
  std::optional<Number> TakeNumber() {
    const auto taken = Take(sizeof(Number));
    if (!taken) return std::nullopt;
    return LoadNumber<Number>(*taken, 0);
  }

  // Characters up to a NUL, which is consumed; nullopt when there is none among the next
  // `max_length` + 1 bytes.
  std::optional<std::string_view> TakeName(size_t max_length) {
    const auto rest = bytes_.subspan(position_);
    const std::string_view text(reinterpret_cast<const char*>(rest.data()), rest.size());
    const size_t end = text.substr(0, max_length + 1).find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    position_ += end + 1;
    return text.substr(0, end);
  }

 private:
  std::span<const std::byte> bytes_;
  size_t position_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_LITTLE_ENDIAN_H_
