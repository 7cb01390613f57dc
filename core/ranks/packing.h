#ifndef BCCSKEL_CORE_RANKS_PACKING_H_
#define BCCSKEL_CORE_RANKS_PACKING_H_

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "core/ranks/exchange.h"

namespace bccskel::ranks {

// Copies values byte by byte: all ranks run the same program on machines of one kind.
template <typename T>
void Pack(std::span<const T> values, Bytes& to) {
  static_assert(std::is_trivially_copyable_v<T>);
  const size_t at = to.size();
  to.resize(at + values.size_bytes());
  if (!values.empty()) std::memcpy(to.data() + at, values.data(), values.size_bytes());
}
template <typename T>
requires(!std::is_const_v<T>) void Pack(std::span<T> values,
                                        Bytes& to) {  // or it would be packed as a value
  Pack(std::span<const T>(values), to);
}
template <typename T>
void Pack(const T& value, Bytes& to) {
  Pack(std::span<const T>(&value, 1), to);
}

// Reads values in the order in which they were packed. Needs: they were packed.
class Unpacker {
 public:
  explicit Unpacker(const Bytes& bytes) : rest_(bytes) {}

  bool done() const { return rest_.empty(); }

  template <typename T, size_t kExtent>
  void Take(std::span<T, kExtent> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!values.empty()) std::memcpy(values.data(), rest_.data(), values.size_bytes());
    rest_ = rest_.subspan(values.size_bytes());
  }
  template <typename T>
  T Take() {
    T value;
    Take(std::span<T>(&value, 1));
    return value;
  }
  // All remaining values.
  template <typename T>
  std::vector<T> TakeRest() {
    std::vector<T> values(rest_.size() / sizeof(T));
    Take(std::span<T>(values));
    return values;
  }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_PACKING_H_
