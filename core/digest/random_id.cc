#include "core/digest/random_id.h"

#include <random>

#include "absl/strings/str_cat.h"

namespace bccskel {

std::string RandomId() {
  constexpr int kWords = 4;
  thread_local std::random_device device;  // opening one takes longer than the rest
  std::string id;
  for (int n = 0; n < kWords; ++n) absl::StrAppend(&id, absl::Hex(device(), absl::kZeroPad8));
  return id;
}

}  // namespace bccskel
