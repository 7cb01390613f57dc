#ifndef BCCSKEL_TESTS_BENCH_REFERENCE_SKELETON_H_
#define BCCSKEL_TESTS_BENCH_REFERENCE_SKELETON_H_

#include <string>

#include "absl/status/statusor.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// SkeletonDigest() of the skeleton whose points the slow reference finds.
// Cost: about a microsecond per point, one byte per integer coordinate of the object's box.
absl::StatusOr<std::string> ReferenceDigest(const Volume& object);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_BENCH_REFERENCE_SKELETON_H_
