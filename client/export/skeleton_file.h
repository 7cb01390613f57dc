#ifndef BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_
#define BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
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
  kPng,
  kHtml,
  kPrecomputed
};

// The format by the ending of a file, in upper or lower case; a folder's may be followed by a
// slash.
// Errors: INVALID_ARGUMENT with the known endings.
absl::StatusOr<SkeletonFormat> SkeletonFormatOf(const std::string& path);

// Whether files of this format also show the object.
bool ShowsObject(SkeletonFormat format);
bool ShowsObject(const std::string& path);  // false for an unknown ending

// The endings, for messages: ".swc, .vtp, ...".
std::string SkeletonFormatEndings();

// A graph and the facts about it: the input of all formats except pictures, JSON and volumes.
struct GraphSubject {
  const SkeletonGraph& graph;
  GraphContext context = {};
  World world = {};
  CurveSampling swc = {};  // of SWC and precomputed files
};

// Whether WriteGraphFile() can write a file of this name.
bool HoldsGraph(const std::string& path);

// Whether WriteSkeletonFile() can begin to write there; leaves no trace. Accepts any ending.
// Errors: those of CheckWritable() and CheckPrecomputedFolder().
absl::Status CheckOutput(const std::string& path);

// Writes one file, or for kPrecomputed a folder of files, completely or not at all. Equal subjects
// give equal bytes. Returns what the format could not hold, as a sentence for the user; empty if it
// held everything.
// Needs:  for kVolume (.exr, .bccb), a result with its thin volume.
// Errors: INVALID_ARGUMENT (ending; coordinates too large for a double); UNIMPLEMENTED for kPng
//         without the subject's `draw`; those of WriteFileAtomically(); for formats that show the
//         object those of the subject's context.
absl::StatusOr<std::string> WriteSkeletonFile(const std::string& path, const Subject& subject);

// The same for a graph alone; ended by the stop token of its context.
// Errors: as above; INVALID_ARGUMENT for formats that need the object or the whole result.
absl::StatusOr<std::string> WriteGraphFile(const std::string& path, const GraphSubject& subject);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_
