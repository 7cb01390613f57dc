#ifndef BCCSKEL_CORE_PIPELINE_NOTES_H_
#define BCCSKEL_CORE_PIPELINE_NOTES_H_

#include <string>
#include <vector>

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// What a user of this result should know, a sentence each: closed surfaces that cavities leave in a
// curve skeleton, topology that preparing changed, simple points left on purpose, an object of
// which nothing is left. Empty for most.
std::vector<std::string> NotesOn(const SkeletonizeResult& result);

// "5 cavities filled" and the like.
std::string WordsFor(const PreparingStep& step);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_NOTES_H_
