#ifndef BCCSKEL_CORE_PIPELINE_NOTES_H_
#define BCCSKEL_CORE_PIPELINE_NOTES_H_

#include <string>
#include <vector>

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// What users of this result should know, one sentence each: closed surfaces that cavities leave in
// a curve skeleton; plates and shells, which curves represent poorly; loops of a mask as narrow as
// noise makes them; very many components; topology changed by sampling or preparing; simple points
// left on purpose; an object that preparing removed entirely. Usually empty.
std::vector<std::string> NotesOn(const SkeletonizeResult& result);

// Describes the step, for example "5 cavities filled".
std::string WordsFor(const PreparingStep& step);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_NOTES_H_
