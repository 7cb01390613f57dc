#ifndef BCCSKEL_SERVER_DECODING_DECODING_CHILD_H_
#define BCCSKEL_SERVER_DECODING_DECODING_CHILD_H_

#include <optional>
#include <string>
#include <vector>

namespace bccskel::server {

// The channel's descriptor in a child.
inline constexpr int kChildChannel = 3;
inline constexpr const char* kChildArgument = "--decoding-child";
// A child ends so when it cannot get memory.
inline constexpr int kChildOutOfMemory = 3;

// How the running program is started as a child.
std::vector<std::string> ThisProgramAsChild();

// Takes from this process for good what decoding does not need: new privileges, files, core dumps,
// executable memory and every system call but a dozen. It ends with its parent. Where the kernel
// has no seccomp, limits and privileges are all that is taken.
// Needs: one thread, no untrusted byte read yet.
void EnterChildSandbox();

// The first thing that main() does: where the program was started as a child, decodes volumes until
// the server closes the channel; then main() must return the exit code.
std::optional<int> RunIfDecodingChild(int argc, const char* const* argv);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_DECODING_CHILD_H_
