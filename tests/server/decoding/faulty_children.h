#ifndef BCCSKEL_TESTS_SERVER_DECODING_FAULTY_CHILDREN_H_
#define BCCSKEL_TESTS_SERVER_DECODING_FAULTY_CHILDREN_H_

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bccskel::test {

// Children of this program that take a volume and then go wrong. The fault is what a decoder that
// was taken over, or has a defect, could do.
inline const std::vector<std::string> kChildFaults = {
    "crash",     // ends with SIGSEGV
    "loop",      // uses its processor time
    "allocate",  // takes memory without end
    "garbage",   // answers with bytes that are no volume
    "promise",   // answers with more bytes than any volume has
    "mute",      // closes the channel
    "outside",   // calls what the sandbox forbids
};
std::vector<std::string> ChildWith(const std::string& fault);

// Open descriptors of this process.
inline size_t OpenDescriptors() {
  const std::filesystem::directory_iterator files("/proc/self/fd"), end;
  return static_cast<size_t>(std::distance(files, end));
}
// Children of this process that have ended and are not waited for.
int Zombies();

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_DECODING_FAULTY_CHILDREN_H_
