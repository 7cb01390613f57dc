#include "proto/address/address.h"

#include <gtest/gtest.h>

namespace bccskel {
namespace {

TEST(CheckAddress, KnowsWhichAddressesStayOnThisMachine) {
  for (const char* address :
       {"unix:/run/x", "localhost:1", "127.0.0.1:0", "127.1.2.3:80", "[::1]:65535"}) {
    EXPECT_TRUE(CheckAddress(address).ok()) << address;
    EXPECT_TRUE(IsOfThisMachine(address)) << address;
  }
  for (const char* address :
       {"0.0.0.0:1", "[::]:1", "server:1", "10.0.0.1:1", "localhost.example:1", "127.example:1"}) {
    EXPECT_TRUE(CheckAddress(address).ok()) << address;
    EXPECT_FALSE(IsOfThisMachine(address)) << address;
  }
  for (const char* address : {"", "unix:", "host", "host:", ":1", "host:65536", "host:-1",
                              "host:http", "host:+1", "host: 1", "ho st:1", "http://host:1"}) {
    EXPECT_FALSE(CheckAddress(address).ok()) << address;
  }
}

}  // namespace
}  // namespace bccskel
