#ifndef BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_
#define BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/subject.h"

namespace bccskel::exporting {

enum class SkeletonFormat {
  kSwc,
  kVtp,
  kGraphMl,
  kObj,
  kJson,
  kCsv,
  kMarkups,
  kGlb,
  kVolume,
  kSvg,
  kHtml,
  kPrecomputed
};

// The format that a file's ending asks for, in capitals or not; of a folder also with a slash
// behind. Errors: INVALID_ARGUMENT with the endings there are.
absl::StatusOr<SkeletonFormat> SkeletonFormatOf(const std::string& path);

// The endings, for messages: ".swc, .vtp, ...".
std::string SkeletonFormatEndings();

// Whether WriteSkeletonFile() can begin to write there, without a trace. Any ending is taken.
// Errors: those of CheckWritable() and CheckPrecomputedFolder().
absl::Status CheckOutput(const std::string& path);

// Writes one file, or for kPrecomputed a folder of them; either all of it appears or nothing. Equal
// subjects give equal bytes. Returns what the format could not hold, a sentence for the user; empty
// if it held everything. Needs:  for kVolume (.exr, .bccb), a result with its thin volume. Errors:
// INVALID_ARGUMENT (ending; coordinates too large for a double), those of
//         WriteFileAtomically(), and for kHtml those of the subject's context.
absl::StatusOr<std::string> WriteSkeletonFile(const std::string& path, const Subject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_
