#include "core/digest/sha256.h"

#include <gtest/gtest.h>

#include <string>

namespace bccskel {
namespace {

// The examples of FIPS 180-4.
TEST(Sha256, MatchesThePublishedExamples) {
  EXPECT_EQ(Sha256Of("").Hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256Of("abc").Hex(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256Of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq").Hex(),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, IsTheSameHoweverTheMessageIsCut) {
  const std::string message(1000, 'x');
  for (size_t cut : {0u, 1u, 63u, 64u, 65u, 999u, 1000u}) {
    Sha256 sha;
    sha.Add(std::string_view(message).substr(0, cut));
    sha.Add(std::string_view(message).substr(cut));
    EXPECT_EQ(sha.Finish(), Sha256Of(message)) << "cut at " << cut;
  }
}

// The digest of the digests of the messages of 0 to 199 bytes.
TEST(Sha256, PadsMessagesOfEveryLength) {
  Sha256 all;
  for (size_t size = 0; size < 200; ++size) all.Add(Sha256Of(std::string(size, 'x')).Hex());
  EXPECT_EQ(all.Finish().Hex(), "f61ffcc417e1f0e59eba2da7fa32fbe05b64e478b68c6bacf990455f00248b98");
}

TEST(Sha256, StartsANewMessageAfterFinish) {
  Sha256 sha;
  sha.Add("first");
  sha.Finish();
  sha.Add("abc");
  EXPECT_EQ(sha.Finish(), Sha256Of("abc"));
}

TEST(Sha256, AddsNumbersLittleEndian) {
  Sha256 sha;
  sha.AddUint64(0x0807060504030201u);
  EXPECT_EQ(sha.Finish(), Sha256Of("\1\2\3\4\5\6\7\10"));
}

}  // namespace
}  // namespace bccskel
