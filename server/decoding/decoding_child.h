#ifndef BCCSKEL_SERVER_DECODING_DECODING_CHILD_H_
#define BCCSKEL_SERVER_DECODING_DECODING_CHILD_H_

#include <optional>
#include <string>
#include <vector>

namespace bccskel::server {

// The channel's descriptor in a child.
inline constexpr int kChildChannel = 3;
inline constexpr const char* kChildArgument = "--decoding-child";
// Exit code of a child that runs out of memory.
inline constexpr int kChildOutOfMemory = 3;

// The command that starts the running program as a child. Needs: RunIfDecodingChild() in its
// main().
std::vector<std::string> ThisProgramAsChild();

// Irrevocably gives up what decoding does not need: new privileges, files, core dumps, executable
// memory and all but a dozen system calls. The process ends with its parent. If the kernel lacks
// seccomp, only limits and privileges are given up.
// Needs: one thread, no untrusted byte read yet.
void EnterChildSandbox();

// Called first in main(). If the program was started as a child, decodes volumes until the server
// closes the channel, and yields the exit code that main() must return.
std::optional<int> RunIfDecodingChild(int argc, const char* const* argv);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DECODING_DECODING_CHILD_H_
