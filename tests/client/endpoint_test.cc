#include "client/endpoint.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/skeletonize_client.h"

namespace bccskel::client {
namespace {

const std::string kCertificate = "-----BEGIN CERTIFICATE-----\nMII\n-----END CERTIFICATE-----\n";
const std::string kKey = "-----BEGIN PRIVATE KEY-----\nMII\n-----END PRIVATE KEY-----\n";

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
  EXPECT_EQ(MakeGrpcStub(endpoint).status(), refused);
  endpoint.tls.ca = kCertificate;
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

TEST(Endpoint, ATokenIsSentWithoutTheWhitespaceAroundIt) {
  for (const char* text :
       {"bccskel_secret", "bccskel_secret\n", " bccskel_secret\r\n", "\tbccskel_secret "}) {
    EXPECT_EQ(*TokenToSend(text), "bccskel_secret");
    Endpoint endpoint = WithToken("localhost:1");
    endpoint.token = text;
    EXPECT_TRUE(CheckEndpoint(endpoint).ok());
  }
  EXPECT_EQ(*TokenToSend(""), "");
}

TEST(Endpoint, ATokenThatNoHeaderHoldsIsRefusedAndNotShown) {
  using std::string_literals::operator""s;
  for (const std::string& text :
       {"secr\u00e9t"s, "secret secret"s, "secret\nsecret"s, "secret\0secret"s, "secret\x7f"s,
        "\xef\xbb\xbfsecret"s, "\n"s, " "s}) {
    Endpoint endpoint = WithToken("localhost:1");
    endpoint.token = text;
    const absl::Status refused = CheckEndpoint(endpoint);
    EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_EQ(std::string(refused.message()).find("secr"), std::string::npos);
    EXPECT_EQ(MakeGrpcStub(endpoint).status(), refused);
    EXPECT_EQ(TokenToSend(text).status(), refused);
  }
}

TEST(Endpoint, AnAddressHasNoControlCharacters) {
  using std::string_literals::operator""s;
  for (const std::string& address :
       {"a\rb:1"s, "a\x01:1"s, "a\0.example:1"s, "a\x7f:1"s, "unix:/run/x\0y"s}) {
    Endpoint endpoint;
    endpoint.address = address;
    EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument) << address;
  }
}

TEST(Endpoint, ACertificateNeedsItsKeyAndTls) {
  Endpoint endpoint;
  endpoint.address = "a:1";
  endpoint.tls.certificate = kCertificate;
  EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
  endpoint.tls.key = kKey;
  EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
  endpoint.tls.ca = kCertificate;
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
  endpoint.tls.certificate.clear();
  EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
}

TEST(Endpoint, AnAddressIsAHostWithAPortOrAPath) {
  for (const char* address : {"a:1", "[::1]:65535", "unix:/run/x:y", "dns:///a:1"}) {
    Endpoint endpoint;
    endpoint.address = address;
    EXPECT_TRUE(CheckEndpoint(endpoint).ok()) << address;
  }
  for (const char* address : {"", ":", ":1", " :1", "unix:", "a", "localhost", "[::1]", "a:", "a:b",
                              "a:0", "a:65536", "a:4294967297", "http://a:1", "http://"}) {
    Endpoint endpoint;
    endpoint.address = address;
    EXPECT_EQ(
        CheckEndpoint(endpoint),
        absl::InvalidArgumentError(absl::StrCat(
            "'", address, "' is neither HOST:PORT, with a port of 1 to 65535, nor unix:PATH")));
  }
}

TEST(Endpoint, AHostAloneIsThatOfAServerWithTls) {
  Endpoint endpoint;
  endpoint.address = "skeletons.example.org";
  EXPECT_FALSE(CheckEndpoint(endpoint).ok());
  endpoint.tls.ca = kCertificate;
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
}

TEST(Endpoint, FilesThatAreNoPemAreRefused) {
  Endpoint endpoint;
  endpoint.address = "a:1";
  endpoint.tls = {.ca = kCertificate, .certificate = kCertificate, .key = kKey};
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
  for (std::string* text : {&endpoint.tls.ca, &endpoint.tls.certificate, &endpoint.tls.key}) {
    const std::string good = std::exchange(*text, "PEM");
    EXPECT_EQ(CheckEndpoint(endpoint).code(), absl::StatusCode::kInvalidArgument);
    *text = good;
  }
}

TEST(Endpoint, ThePathOfASocketHasALimit) {
  Endpoint endpoint;
  endpoint.address = "unix:" + std::string(107, 'a');
  EXPECT_TRUE(CheckEndpoint(endpoint).ok());
  endpoint.address += 'a';
  EXPECT_EQ(CheckEndpoint(endpoint),
            absl::InvalidArgumentError(
                absl::StrCat("'", endpoint.address,
                             "': the path of a socket has at most 107 characters, this "
                             "one 108; use a shorter one, such as that of a link to its folder")));
}

}  // namespace
}  // namespace bccskel::client
