#ifndef BCCSKEL_TESTS_SUPPORT_OBJECT_PARTS_H_
#define BCCSKEL_TESTS_SUPPORT_OBJECT_PARTS_H_

#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// What several parts make together; fails where two have the same brick.
inline absl::StatusOr<Volume> Joined(const std::vector<Volume>& parts) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  for (const Volume& part : parts) {
    keys.insert(keys.end(), part.keys().begin(), part.keys().end());
    bricks.insert(bricks.end(), part.bricks().begin(), part.bricks().end());
  }
  return Volume::Create(parts.front().extent(), parts.front().placement(), std::move(keys),
                        std::move(bricks));
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_OBJECT_PARTS_H_
