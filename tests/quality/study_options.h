#ifndef BCCSKEL_TESTS_QUALITY_STUDY_OPTIONS_H_
#define BCCSKEL_TESTS_QUALITY_STUDY_OPTIONS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::quality {

// Rules are chosen on the even seeds and judged on the odd ones, and on figures kept for that.
enum class Half : uint8_t { kTune, kJudge, kAll };

struct StudyOptions {
  std::vector<uint64_t> points = {100'000};  // of an object
  int turns = 3;                             // random rotations, or seeds
  Half half = Half::kAll;
  std::vector<std::string> as = {"bcc"};  // bcc, mask
  std::vector<double> noise = {0};        // shares, not percent
  std::vector<std::string> only;          // of classes or files; empty: all
  std::string data;                       // a folder, or for some studies a file
  std::string dump;                       // a folder for the objects
  bool json = false;
  SkeletonizeOptions skeleton;

  // Whether a name has one of the wanted parts.
  bool Wants(const std::string& name) const;
};

// Errors: INVALID_ARGUMENT for what is not known, with what is.
absl::StatusOr<StudyOptions> ParseStudyOptions(std::span<const std::string> arguments);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_STUDY_OPTIONS_H_
