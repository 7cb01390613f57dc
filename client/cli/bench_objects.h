#ifndef BCCSKEL_CLIENT_CLI_BENCH_OBJECTS_H_
#define BCCSKEL_CLIENT_CLI_BENCH_OBJECTS_H_

#include <array>
#include <cstdint>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/volume/volume.h"

// What the engine is measured on, here and in tests/bench: shapes of core/import/shapes, but
//   blob        has 2 % of its boundary flipped, as scanned objects have;
//   thin-tubes  are the tubes twelve times as long, about 0.01 % of their box.

namespace bccskel::cli {

inline constexpr std::array<const char*, 7> kBenchObjects = {"ball",  "torus", "horse",     "blob",
                                                             "tubes", "tree",  "thin-tubes"};

// The same points on every machine.
// Errors: INVALID_ARGUMENT for a name that is not in kBenchObjects, and as GenerateShape().
absl::StatusOr<Volume> MakeBenchObject(std::string_view name, uint64_t points);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_OBJECTS_H_
