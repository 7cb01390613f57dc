#include "server/jobs/random_name.h"

#include <random>

#include "absl/strings/str_cat.h"

namespace bccskel::server {

std::string RandomId() {
  constexpr int kWords = 4;
  thread_local std::random_device device;  // opening one takes longer than all the rest
  std::string id;
  for (int n = 0; n < kWords; ++n) absl::StrAppend(&id, absl::Hex(device(), absl::kZeroPad8));
  return id;
}

std::string RandomName(const std::string& kind) { return absl::StrCat(kind, "/", RandomId()); }

}  // namespace bccskel::server
