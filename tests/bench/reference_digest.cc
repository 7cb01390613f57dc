#include <cstdio>
#include <cstdlib>

#include "client/cli/bench_core.h"
#include "core/exec/status_macros.h"
#include "tests/bench/reference_skeleton.h"

// Prints the SHA-256 of the skeleton that the slow reference makes of a bench object.
// Usage: bccskel_reference_digest OBJECT POINTS

namespace {

absl::StatusOr<std::string> DigestOf(const char* name, uint64_t points) {
  BCCSKEL_ASSIGN_OR_RETURN(const bccskel::Volume object,
                           bccskel::cli::MakeBenchObject(name, points));
  return bccskel::test::ReferenceDigest(object);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s OBJECT POINTS\n", argv[0]);
    return 2;
  }
  const auto digest = DigestOf(argv[1], std::strtoull(argv[2], nullptr, 10));
  if (!digest.ok()) {
    std::fprintf(stderr, "%s\n", digest.status().ToString().c_str());
    return 1;
  }
  std::printf("%s\n", digest->c_str());
  return 0;
}
