#include "server/settings/memory_limit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/server/support/running_server.h"

namespace bccskel::server {
namespace {

class MemoryLimitTest : public testing::Test {
 protected:
  void Write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = root() + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text << "\n";
  }
  std::string root() const { return folder_.File("root"); }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(MemoryLimitTest, IsTheMachinesWhereNoGroupHasOne) {
  const uint64_t machine = AvailableMemoryBytes(root());
  EXPECT_GT(machine, uint64_t{1} << 20);
  Write("/proc/self/cgroup", "0::/a");
  Write("/sys/fs/cgroup/a/memory.max", "max");
  EXPECT_EQ(AvailableMemoryBytes(root()), machine);
  Write("/sys/fs/cgroup/a/memory.max", "9223372036854771712");
  EXPECT_EQ(AvailableMemoryBytes(root()), machine);
}

TEST_F(MemoryLimitTest, IsTheLeastOfTheGroupAndThoseAroundIt) {
  Write("/proc/self/cgroup", "0::/system.slice/bccskel.service");
  Write("/sys/fs/cgroup/system.slice/bccskel.service/memory.max", "3000000");
  EXPECT_EQ(AvailableMemoryBytes(root()), 3'000'000u);
  Write("/sys/fs/cgroup/system.slice/memory.max", "2000000");
  EXPECT_EQ(AvailableMemoryBytes(root()), 2'000'000u);
}

TEST_F(MemoryLimitTest, InAContainerTheTopmostGroupIsItsOwn) {
  Write("/proc/self/cgroup", "0::/");
  Write("/sys/fs/cgroup/memory.max", "5000000");
  EXPECT_EQ(AvailableMemoryBytes(root()), 5'000'000u);
}

TEST_F(MemoryLimitTest, KnowsTheFirstVersionToo) {
  Write("/proc/self/cgroup", "12:cpu,cpuacct:/x\n9:memory:/docker/0a1b\n0::/y");
  Write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "4000000");  // seen from inside
  EXPECT_EQ(AvailableMemoryBytes(root()), 4'000'000u);
}

}  // namespace
}  // namespace bccskel::server
