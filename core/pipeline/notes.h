#ifndef BCCSKEL_CORE_PIPELINE_NOTES_H_
#define BCCSKEL_CORE_PIPELINE_NOTES_H_

#include <string>
#include <vector>

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// What the user of this result should know, one sentence each: closed surfaces that cavities leave
// in a curve skeleton, plates and shells, of which curves say little, loops of a mask as narrow as
// noise makes them, very many components, topology that preparing changed, simple points left on
// purpose, an object that preparing removed entirely. Mostly empty.
std::vector<std::string> NotesOn(const SkeletonizeResult& result);

// "5 cavities filled" and the like.
std::string WordsFor(const PreparingStep& step);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_NOTES_H_
