#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "server/connection_acceptor.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

TEST(SocketLock, IsHeldByOneUntilItsEnd) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "s";
  {
    const auto first = SocketLock::Take(path);
    ASSERT_TRUE(first.ok()) << first.status();
    EXPECT_EQ(SocketLock::Take(path).status().code(), absl::StatusCode::kAlreadyExists);
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
  EXPECT_TRUE(SocketLock::Take(path).ok());
}

TEST(SocketLock, MovesWithItsHolder) {
  const test::TemporaryFolder folder;
  auto first = SocketLock::Take(folder / "s");
  ASSERT_TRUE(first.ok());
  std::optional<SocketLock> second(*std::move(first));
  EXPECT_FALSE(SocketLock::Take(folder / "s").ok());
  second.reset();
  EXPECT_TRUE(SocketLock::Take(folder / "s").ok());
}

TEST(SocketLock, AFileThatACrashLeftIsNoObstacle) {
  const test::TemporaryFolder folder;
  {
    const auto left = std::fopen((folder / "s.lock").c_str(), "w");
    std::fclose(left);
  }
  EXPECT_TRUE(SocketLock::Take(folder / "s").ok());
}

TEST(SocketLock, AFolderThatDoesNotExistIsAnInvalidArgument) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(SocketLock::Take(folder / "no/s").status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(SocketLock, ManyWhoTakeAndLeaveItNeverHoldItTogether) {
  const test::TemporaryFolder folder;
  std::atomic<int> holders = 0, taken = 0;
  std::vector<std::jthread> threads;
  for (int n = 0; n < 4; ++n) {
    threads.emplace_back([&] {
      for (int turn = 0; turn < 500; ++turn) {
        const auto lock = SocketLock::Take(folder / "s");
        if (!lock.ok()) continue;
        EXPECT_EQ(++holders, 1);
        ++taken;
        --holders;
      }
    });
  }
  threads.clear();
  EXPECT_GT(taken, 0);
}

TEST(ConnectionAcceptor, LeavesASocketThatAServerListensOnThoughItsLockWasRemoved) {
  const test::TemporaryFolder folder;
  const std::string address = "unix:" + (folder / "s");
  {
    const auto first = ConnectionAcceptor::Listen(address);
    ASSERT_TRUE(first.ok()) << first.status();
    EXPECT_EQ(ConnectionAcceptor::Listen(address).status().code(),
              absl::StatusCode::kAlreadyExists);
    EXPECT_TRUE(std::filesystem::is_socket(folder / "s"));
  }
  EXPECT_TRUE(ConnectionAcceptor::Listen(address).ok());
}

}  // namespace
}  // namespace bccskel::server
