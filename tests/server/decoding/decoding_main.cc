#include <dirent.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "server/decoding/child_channel.h"
#include "server/decoding/decoding_child.h"
#include "tests/server/decoding/faulty_children.h"

namespace bccskel::test {
namespace {

using server::ChildChannel;
using server::ReplyKind;

constexpr const char* kFaultArgument = "--faulty-child";

void Answer(ChildChannel& channel, uint64_t bytes) {
  channel.SendMessage(server::DecodeReply{.kind = ReplyKind::kVolume, .bytes = bytes})
      .IgnoreError();
  const std::vector<std::byte> garbage(4096, std::byte{0x5a});
  channel.Send(garbage).IgnoreError();
}

void Allocate() {
  for (;;) {
    constexpr size_t kStep = size_t{1} << 20;
    std::memset(::operator new(kStep), 1, kStep);
  }
}

void GoWrong(const std::string& fault, ChildChannel& channel) {
  if (fault == "crash") std::raise(SIGSEGV);
  for (volatile bool looping = fault == "loop"; looping;) {
  }
  if (fault == "garbage") Answer(channel, 4096);
  if (fault == "promise") Answer(channel, uint64_t{1} << 60);
  if (fault == "outside") std::system("true");  // NOLINT: the sandbox must end it
  if (fault == "allocate") {
    try {
      Allocate();
    } catch (const std::bad_alloc&) {
      _exit(server::kChildOutOfMemory);
    }
  }
  if (fault == "mute") _exit(0);
  pause();
}

int RunFaultyChild(const std::string& fault) {
  server::EnterChildSandbox();
  ChildChannel channel{exec::Descriptor(server::kChildChannel)};
  channel.SendMessage(server::ChildHello{.address_space_bytes = uint64_t{1} << 28}).IgnoreError();
  server::DecodeRequest request;
  exec::Descriptor file;
  if (!channel.ReceiveRequest(request, file).ok()) return 0;
  channel.SendMessage(server::DecodeReply()).IgnoreError();
  GoWrong(fault, channel);
  return 0;
}

}  // namespace

std::vector<std::string> ChildWith(const std::string& fault) {
  return {"/proc/self/exe", kFaultArgument, fault};
}

int Zombies() {
  int zombies = 0;
  siginfo_t info = {};
  while (waitid(P_ALL, 0, &info, WEXITED | WNOHANG) == 0 && info.si_pid != 0) {
    ++zombies;
    info = {};
  }
  return zombies;
}

}  // namespace bccskel::test

int main(int argc, char** argv) {
  if (const auto code = bccskel::server::RunIfDecodingChild(argc, argv)) return *code;
  if (argc == 3 && std::strcmp(argv[1], bccskel::test::kFaultArgument) == 0) {
    return bccskel::test::RunFaultyChild(argv[2]);
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
