#include "client/endpoint.h"

#include <gtest/gtest.h>

#include <string>

#include "client/connection.h"

namespace bccskel::client {
namespace {

Endpoint WithToken(const std::string& address) {
  Endpoint endpoint;
  endpoint.address = address;
  endpoint.token = "bccskel_secret";
  return endpoint;
}

TEST(Endpoint, ATokenDoesNotCrossANetworkInTheClear) {
  Endpoint endpoint = WithToken("server.example:50051");
  const absl::Status refused = CheckEndpoint(endpoint);
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(std::string(refused.message()).find(endpoint.token), std::string::npos);
  EXPECT_EQ(Connect(endpoint).status(), refused);
  endpoint.tls.ca = "PEM";
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
  endpoint.tls.ca.clear();
  endpoint.plaintext_token = Endpoint::PlaintextToken::kAllow;
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
}

TEST(Endpoint, ATokenMayStayOnThisMachine) {
  for (const char* address : {"127.0.0.1:1", "localhost:1", "[::1]:1", "unix:/run/x"}) {
    EXPECT_TRUE(CheckEndpoint(WithToken(address)).ok()) << address;
  }
  for (const char* address : {"localhost.example:1", "127.example:1", "10.0.0.1:1"}) {
    EXPECT_FALSE(CheckEndpoint(WithToken(address)).ok()) << address;
  }
}

TEST(Endpoint, ACertificateNeedsItsKeyAndTls) {
  Endpoint endpoint;
  endpoint.tls.certificate = "PEM";
  EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
  endpoint.tls.key = "PEM";
  EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
  endpoint.tls.ca = "PEM";
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
  endpoint.tls.certificate.clear();
  EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel::client
