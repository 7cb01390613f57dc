#include "core/io/volume_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/io/volume_encoder.h"
#include "tests/core/io/test_volumes.h"
#include "tests/support/object_parts.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class VolumeFile : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  void Put(const std::string& name, const std::string& bytes) const { folder_.Write(name, bytes); }
  void PutVolume(const std::string& name, const Volume& volume, VolumeEncoding encoding,
                 VolumeCompression compression) const {
    Put(name, *EncodeVolume(volume, {.encoding = encoding, .compression = compression}));
  }
  std::string Get(const std::string& name) const { return test::BytesOfFile(Path(name)); }

  const test::TemporaryFolder folder_;
};

TEST_F(VolumeFile, ComesBackFromEitherFormat) {
  for (const Volume& volume : EdgeVolumes()) {
    for (const char* name : {"v.exr", "v.bccb", "v.EXR", "v.Bccb"}) {
      const absl::Status written = WriteVolumeFile(Path(name), volume);
      ASSERT_TRUE(written.ok()) << written;
      const auto back = ReadVolumeFile(Path(name));
      ASSERT_TRUE(back.ok()) << back.status();
      EXPECT_EQ(*back, volume);
    }
  }
}

TEST_F(VolumeFile, ComesBackWhenItIsLargerThanOneRead) {
  const Volume volume = RandomVolume({700, 500, 96}, 5);
  for (VolumeEncoding encoding : {VolumeEncoding::kOpenExr, VolumeEncoding::kBricks}) {
    PutVolume("v", volume, encoding, VolumeCompression::kNone);
    EXPECT_EQ(*ReadVolumeFile(Path("v")), volume);
  }
}

TEST_F(VolumeFile, PartsOfReadersAreTheWholeTogether) {
  const Volume volume = RandomVolume({300, 200, 150}, 6);
  struct Kind {
    VolumeEncoding encoding;
    VolumeCompression compression;
  };
  for (const Kind& kind : {Kind{VolumeEncoding::kBricks, VolumeCompression::kNone},
                           Kind{VolumeEncoding::kBricks, VolumeCompression::kZstd},
                           Kind{VolumeEncoding::kOpenExr, VolumeCompression::kZip}}) {
    PutVolume("v", volume, kind.encoding, kind.compression);
    for (const int32_t count : {1, 2, 3, 7, 50}) {
      std::vector<Volume> parts;
      for (int32_t index = 0; index < count; ++index) {
        auto part = ReadVolumePart(Path("v"), {index, count});
        ASSERT_TRUE(part.ok()) << part.status();
        parts.push_back(*std::move(part));
      }
      EXPECT_EQ(*test::Joined(parts), volume);
      if (kind.encoding == VolumeEncoding::kBricks && count == 2) {
        EXPECT_LT(parts[0].brick_count(), volume.brick_count() * 2 / 3);
      }
    }
  }
}

TEST_F(VolumeFile, PlainBricksOfAnotherLengthAreRefusedByEachReader) {
  PutVolume("v", RandomVolume({60, 60, 60}, 7), VolumeEncoding::kBricks, VolumeCompression::kNone);
  const std::string bytes = Get("v");
  for (const std::string& other : {bytes.substr(0, bytes.size() - 1), bytes + "x"}) {
    Put("v", other);
    for (const int32_t index : {0, 1}) {
      EXPECT_THAT(std::string(ReadVolumePart(Path("v"), {index, 2}).status().message()),
                  HasSubstr("declared"));
    }
  }
}

TEST_F(VolumeFile, IsRecognizedByItsBytesNotItsName) {
  const Volume volume = RandomVolume({20, 20, 20}, 5);
  ASSERT_TRUE(WriteVolumeFile(Path("v.bccb"), volume).ok());
  fs::rename(Path("v.bccb"), Path("v.exr"));
  EXPECT_EQ(*ReadVolumeFile(Path("v.exr")), volume);
}

TEST_F(VolumeFile, HasTheHeaderOfItsVolume) {
  const Volume volume = RandomVolume({20, 21, 22}, 5);
  ASSERT_TRUE(WriteVolumeFile(Path("v.exr"), volume).ok());
  const std::string bytes = Get("v.exr");
  EXPECT_EQ(*SniffVolumeEncoding(BytesOf(bytes)), VolumeEncoding::kOpenExr);
  const auto header = ScanVolumeHeader(VolumeEncoding::kOpenExr, BytesOf(bytes), {});
  ASSERT_TRUE(header.ok()) << header.status();
  EXPECT_EQ(header->compression, VolumeCompression::kZip);
  EXPECT_EQ(header->extent, volume.extent());
  EXPECT_EQ(header->placement, volume.placement());
  EXPECT_EQ(header->declared_bricks, volume.brick_count());
}

TEST_F(VolumeFile, SaysWhichFileIsWrongAndWhy) {
  const auto missing = ReadVolumeFile(Path("none.exr"));
  EXPECT_EQ(missing.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(missing.status().message()), HasSubstr(Path("none.exr")));
  Put("text.exr", "no volume at all");
  const auto text = ReadVolumeFile(Path("text.exr"));
  EXPECT_EQ(text.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(text.status().message()), HasSubstr(Path("text.exr") + ": not a volume"));
  Put("empty.exr", "");
  EXPECT_EQ(ReadVolumeFile(Path("empty.exr")).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_FALSE(ReadVolumeFile(folder_.path()).ok());
}

TEST_F(VolumeFile, RefusesNamesThatAreNoFileFormat) {
  const Volume volume = FullVolume({2, 2, 2});
  EXPECT_EQ(WriteVolumeFile(Path("v.png"), volume).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(WriteVolumeFile(Path("no/such/folder.exr"), volume).code(),
            absl::StatusCode::kNotFound);
  EXPECT_EQ(folder_.Count(), 0u);
}

TEST_F(VolumeFile, LeavesTheOldFileWhenWritingFails) {
  Put("v.exr", "old");
  const Volume huge = CornerVolume({1 << 20, 1 << 20, 1 << 10});
  const absl::Status refused = WriteVolumeFile(Path("v.exr"), huge);
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(refused.message()), HasSubstr(".bccb"));
  EXPECT_EQ(Get("v.exr"), "old");
  EXPECT_EQ(folder_.Count(), 1u);
}

TEST_F(VolumeFile, ReplacesTheOldFileAndHonorsTheUmask) {
  Put("v.bccb", "old");
  const Volume volume = FullVolume({2, 2, 2});
  const mode_t before = umask(027);
  const absl::Status written = WriteVolumeFile(Path("v.bccb"), volume);
  umask(before);
  ASSERT_TRUE(written.ok()) << written;
  EXPECT_EQ(*ReadVolumeFile(Path("v.bccb")), volume);
  EXPECT_EQ(folder_.Count(), 1u);
  struct stat status = {};
  ASSERT_EQ(stat(Path("v.bccb").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(VolumeFile, ALinkStaysALink) {
  Put("v.exr", "old");
  fs::create_symlink("v.exr", Path("link.exr"));
  fs::create_symlink("/dev/null", Path("null.exr"));
  const Volume volume = FullVolume({2, 2, 2});
  for (const char* link : {"link.exr", "null.exr"}) {
    const absl::Status written = WriteVolumeFile(Path(link), volume);
    ASSERT_TRUE(written.ok()) << written;
    EXPECT_TRUE(fs::is_symlink(Path(link))) << link;
  }
  EXPECT_EQ(*ReadVolumeFile(Path("v.exr")), volume);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(folder_.Count(), 3u);
}

// What a program prints on standard output, and its exit status.
std::pair<std::string, int> RunProgram(const std::string& command) {
  std::string output;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  while (size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), count);
  }
  return {output, pclose(pipe)};
}

bool Installed(const std::string& program) {
  return RunProgram("command -v " + program).second == 0;
}

class ForeignProgram : public VolumeFile {
 protected:
  void WriteAs(VolumeCompression compression) {
    PutVolume("v.exr", RandomVolume({33, 21, 70}, 5), VolumeEncoding::kOpenExr, compression);
  }
  static constexpr std::array kCompressions = {VolumeCompression::kNone, VolumeCompression::kRle,
                                               VolumeCompression::kZips, VolumeCompression::kZip};
};

TEST_F(ForeignProgram, ExrheaderShowsBothPartsAndTheAttributes) {
  if (!Installed("exrheader")) GTEST_SKIP() << "exrheader (Debian package openexr) is missing";
  for (VolumeCompression compression : kCompressions) {
    WriteAs(compression);
    const auto [output, status] = RunProgram("exrheader " + Path("v.exr"));
    EXPECT_EQ(status, 0) << output;
    for (const char* line :
         {"part 0", "part 1", "name (type string): \"even\"", "name (type string): \"odd\"",
          "bccExtent (type v3i): (33 21 70)", "z0002, 32-bit unsigned integer",
          "bccProfile (type int): 1", "bccSpacing (type v3d)"}) {
      EXPECT_THAT(output, HasSubstr(line));
    }
  }
}

TEST_F(ForeignProgram, OiiotoolReadsEveryPixelOfBothParts) {
  if (!Installed("oiiotool")) GTEST_SKIP() << "oiiotool (openimageio-tools) is missing";
  for (VolumeCompression compression : kCompressions) {
    WriteAs(compression);
    const auto [output, status] = RunProgram("oiiotool -a --info -v --hash " + Path("v.exr"));
    EXPECT_EQ(status, 0) << output;
    EXPECT_THAT(output, HasSubstr("33 x   21, 3 channel, uint openexr"));
    EXPECT_THAT(output, HasSubstr("2 subimages"));
    EXPECT_THAT(output, HasSubstr("SHA-1"));
  }
}

TEST_F(ForeignProgram, ExrstdattrOutputWithAForeignAttributeIsRefused) {
  if (!Installed("exrstdattr")) GTEST_SKIP() << "exrstdattr (Debian package openexr) is missing";
  WriteAs(VolumeCompression::kZip);
  const auto [output, status] =
      RunProgram("exrstdattr -owner somebody " + Path("v.exr") + " " + Path("w.exr"));
  ASSERT_EQ(status, 0) << output;
  EXPECT_THAT(std::string(ReadVolumeFile(Path("w.exr")).status().message()), HasSubstr("'owner'"));
}

TEST_F(ForeignProgram, OpenExrsOwnCopyOfAVolumeIsTheSameVolume) {
  if (!Installed("exrmultipart"))
    GTEST_SKIP() << "exrmultipart (Debian package openexr) is missing";
  WriteAs(VolumeCompression::kZip);
  const auto [output, status] =
      RunProgram("cd " + folder_.path() +
                 " && exrmultipart -separate -i v.exr -o part && exrmultipart -combine -i "
                 "part.1.exr part.2.exr -o w.exr");
  ASSERT_EQ(status, 0) << output;
  const auto copy = ReadVolumeFile(Path("w.exr"));
  ASSERT_TRUE(copy.ok()) << copy.status();
  EXPECT_EQ(*copy, RandomVolume({33, 21, 70}, 5));
}

}  // namespace
}  // namespace bccskel
