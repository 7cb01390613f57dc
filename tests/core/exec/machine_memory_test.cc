#include "core/exec/machine_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/temporary_folder.h"

namespace bccskel::exec {
namespace {

class MachineMemoryTest : public testing::Test {
 protected:
  void Write(const std::string& path, const std::string& text) const {
    root_.Write(path, text + "\n");
  }

  const test::TemporaryFolder root_;
};

TEST_F(MachineMemoryTest, IsTheMachinesWhereNoGroupHasOne) {
  const uint64_t machine = AvailableMemoryBytes(root_.path());
  EXPECT_GT(machine, uint64_t{1} << 20);
  Write("/proc/self/cgroup", "0::/a");
  Write("/sys/fs/cgroup/a/memory.max", "max");
  EXPECT_EQ(AvailableMemoryBytes(root_.path()), machine);
  Write("/sys/fs/cgroup/a/memory.max", "9223372036854771712");
  EXPECT_EQ(AvailableMemoryBytes(root_.path()), machine);
}

TEST_F(MachineMemoryTest, IsTheLeastOfTheGroupAndThoseAroundIt) {
  Write("/proc/self/cgroup", "0::/system.slice/bccskel.service");
  Write("/sys/fs/cgroup/system.slice/bccskel.service/memory.max", "3000000");
  EXPECT_EQ(AvailableMemoryBytes(root_.path()), 3'000'000u);
  Write("/sys/fs/cgroup/system.slice/memory.max", "2000000");
  EXPECT_EQ(AvailableMemoryBytes(root_.path()), 2'000'000u);
}

TEST_F(MachineMemoryTest, InAContainerTheTopmostGroupIsItsOwn) {
  Write("/proc/self/cgroup", "0::/");
  Write("/sys/fs/cgroup/memory.max", "5000000");
  EXPECT_EQ(AvailableMemoryBytes(root_.path()), 5'000'000u);
}

TEST_F(MachineMemoryTest, KnowsTheFirstVersionToo) {
  Write("/proc/self/cgroup", "12:cpu,cpuacct:/x\n9:memory:/docker/0a1b\n0::/y");
  Write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "4000000");  // seen from inside
  EXPECT_EQ(AvailableMemoryBytes(root_.path()), 4'000'000u);
}

TEST(MachineMemory, IsTakenUpToTheLimit) {
  MachineMemory memory(100);
  EXPECT_TRUE(memory.TakeFor(6, 10, "points").ok());
  const absl::Status refused = memory.TakeFor(5, 10, "points");
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(refused.message()),
              testing::StartsWith(
                  "5 points: they need up to 50 bytes of memory, and 60 are reserved already"));
  EXPECT_FALSE(memory.Take(UINT64_MAX, "all").ok());
  memory.GiveBack(10);
  EXPECT_TRUE(memory.TakeFor(5, 10, "points").ok());
}

}  // namespace
}  // namespace bccskel::exec
