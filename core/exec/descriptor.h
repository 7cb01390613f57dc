#ifndef BCCSKEL_CORE_EXEC_DESCRIPTOR_H_
#define BCCSKEL_CORE_EXEC_DESCRIPTOR_H_

#include <unistd.h>

#include <utility>

namespace bccskel::exec {

// Owns a file descriptor and closes it.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  // Whether the system reported no error. Also closes what is invalid afterwards.
  bool Close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || close(number) == 0;
  }

 private:
  int number_ = -1;
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_DESCRIPTOR_H_
