#ifndef BCCSKEL_SERVER_DECODING_DESCRIPTOR_H_
#define BCCSKEL_SERVER_DECODING_DESCRIPTOR_H_

#include <string>
#include <utility>

#include "absl/status/status.h"

namespace bccskel::server {

// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this == &other) return *this;
    Close();
    number_ = std::exchange(other.number_, -1);
    return *this;
  }

  int get() const { return number_; }
  bool valid() const { return number_ >= 0; }

 private:
  void Close();

  int number_ = -1;
};

// The server lacks something that decoding takes: a CallError, so that the caller tries again.
absl::Status NoDecoder(const std::string& what, int error);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_DESCRIPTOR_H_
