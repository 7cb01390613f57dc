#ifndef BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_
#define BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_

#include <stop_token>
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

// The format that a file's ending asks for, in capitals or not; of a folder also with a slash
// behind. Errors: INVALID_ARGUMENT with the endings there are.
absl::StatusOr<SkeletonFormat> SkeletonFormatOf(const std::string& path);

// Whether files of this format show the object, too.
bool ShowsObject(SkeletonFormat format);

// The endings, for messages: ".swc, .vtp, ...".
std::string SkeletonFormatEndings();

// A graph and what is known of it: what all formats but pictures, JSON and volumes are made from.
struct GraphSubject {
  const SkeletonGraph& graph;
  GraphContext context = {};
  World world = {};
  CurveSampling swc = {};  // of SWC and precomputed files
};

// Whether WriteGraphFile() can write a file of this name.
bool HoldsGraph(const std::string& path);

// Whether WriteSkeletonFile() can begin to write there, without a trace. Any ending is taken.
// Errors: those of CheckWritable() and CheckPrecomputedFolder().
absl::Status CheckOutput(const std::string& path);

// Writes one file, or for kPrecomputed a folder of them; either all of it appears or nothing. Equal
// subjects give equal bytes. Returns what the format could not hold, a sentence for the user; empty
// if it held everything.
// Needs:  for kVolume (.exr, .bccb), a result with its thin volume.
// Errors: INVALID_ARGUMENT (ending; coordinates too large for a double), UNIMPLEMENTED for kPng
//         without the subject's `draw`, those of WriteFileAtomically(), for kHtml and kPng those of
//         the subject's context.
absl::StatusOr<std::string> WriteSkeletonFile(const std::string& path, const Subject& subject);

// The same bytes of a graph alone.
// Errors: as above; INVALID_ARGUMENT for formats that need the object or the whole result.
absl::StatusOr<std::string> WriteGraphFile(const std::string& path, const GraphSubject& subject,
                                           const std::stop_token& stop);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_SKELETON_FILE_H_
