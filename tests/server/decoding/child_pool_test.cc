#include "server/decoding/child_pool.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <string>
#include <thread>

#include "core/import/shapes/shapes.h"
#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "server/decoding/decoding_child.h"
#include "server/errors/call_error.h"
#include "tests/server/decoding/faulty_children.h"
#include "tests/support/sanitized.h"

namespace bccskel::server {
namespace {

using test::ChildWith, test::kSanitized;

const Volume& Torus() {
  static const Volume torus = *GenerateShape(Shape::kTorus, {.points = 20'000});
  return torus;
}

std::string Encoded(VolumeCompression compression = VolumeCompression::kRle) {
  return *EncodeVolume(Torus(), {.encoding = VolumeEncoding::kOpenExr, .compression = compression});
}

absl::StatusOr<Volume> DecodeIn(ChildPool& pool, const std::string& bytes,
                                const std::string& tenant = "", const exec::Context& context = {}) {
  const auto all = std::as_bytes(std::span(bytes));
  const auto header = ScanVolumeHeader(VolumeEncoding::kOpenExr, all, {});
  if (!header.ok()) return header.status();
  auto decoder = MakeChildDecoder(*header, {}, tenant, pool);
  if (!decoder.ok()) return decoder.status();
  for (size_t offset = 0; offset < bytes.size(); offset += 1000) {
    const auto part = all.subspan(offset, std::min<size_t>(1000, bytes.size() - offset));
    if (const absl::Status status = (*decoder)->Append(part); !status.ok()) return status;
  }
  return (*decoder)->Finish(context);
}

TEST(ChildPool, DecodesAsThisProcessDoes) {
  ChildPool pool(ThisProgramAsChild());
  for (const auto compression : {VolumeCompression::kNone, VolumeCompression::kRle,
                                 VolumeCompression::kZips, VolumeCompression::kZip}) {
    const auto volume = DecodeIn(pool, Encoded(compression));
    ASSERT_TRUE(volume.ok()) << volume.status();
    EXPECT_EQ(*volume, Torus());
  }
}

TEST(ChildPool, AChildServesOneTenantOnlyAndAgain) {
  ChildPool pool(ThisProgramAsChild());
  auto first = pool.Take("a");
  ASSERT_TRUE(first.ok()) << first.status();
  const pid_t pid = (*first)->pid();
  pool.Keep("a", *std::move(first));
  EXPECT_NE((*pool.Take("b"))->pid(), pid);
  EXPECT_EQ((*pool.Take("a"))->pid(), pid);
}

TEST(ChildPool, AChildThatSawAMalformedVolumeIsNotUsedAgain) {
  ChildPool pool(ThisProgramAsChild());
  ASSERT_TRUE(DecodeIn(pool, Encoded()).ok());
  const std::vector<pid_t> before = pool.idle();
  std::string cut = Encoded();
  cut.pop_back();
  const absl::Status status = DecodeIn(pool, cut).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_EQ(status, DecodeVolume(VolumeEncoding::kOpenExr, cut).status()) << "the same words";
  for (const pid_t pid : pool.idle()) EXPECT_NE(pid, before.front());
}

TEST(ChildPool, KeepsFewIdleChildren) {
  ChildPool pool(ThisProgramAsChild());
  for (int n = 0; n < 8; ++n) {
    const std::string tenant = std::to_string(n);
    pool.Keep(tenant, *pool.Take(tenant));
  }
  EXPECT_LE(pool.idle().size(), 5u);
}

TEST(ChildPool, AnIdleChildThatWasKilledIsReplaced) {
  ChildPool pool(ThisProgramAsChild());
  for (int n = 0; n < 3; ++n) {
    for (const pid_t pid : pool.idle()) kill(pid, SIGKILL);
    absl::StatusOr<Volume> volume = DecodeIn(pool, Encoded());
    // A child that dies unseen is the server's fault, and worth another try.
    while (ReasonOf(volume.status()) == Reason::kDecoderBusy) volume = DecodeIn(pool, Encoded());
    ASSERT_TRUE(volume.ok()) << volume.status();
  }
}

class FaultyChild : public testing::TestWithParam<std::string> {};

TEST_P(FaultyChild, IsTheCallersInvalidArgumentAndLeavesNothing) {
  if (kSanitized && (GetParam() == "allocate" || GetParam() == "outside")) {
    GTEST_SKIP() << "sanitizers need memory and system calls of their own";
  }
  const size_t descriptors = test::OpenDescriptors();
  {
    ChildPool pool(ChildWith(GetParam()));
    const absl::Status status = DecodeIn(pool, Encoded()).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  }
  EXPECT_EQ(test::OpenDescriptors(), descriptors);
  EXPECT_EQ(test::Zombies(), 0);
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultyChild, testing::ValuesIn(test::kChildFaults),
                         [](const auto& test) { return test.param; });

TEST(ChildPool, AChildKilledWithAVolumeInItsHandsIsAnInvalidArgument) {
  ChildPool pool(ChildWith("loop"));
  const auto child = *pool.Take("");
  auto bytes = *SharedBytes::Create();
  const std::string encoded = Encoded();
  ASSERT_TRUE(bytes.Append(std::as_bytes(std::span(encoded))).ok());
  ASSERT_TRUE(bytes.Seal().ok());
  const auto header =
      ScanVolumeHeader(VolumeEncoding::kOpenExr, std::as_bytes(std::span(encoded)), {});
  const std::jthread killer([&child] {
    // Long after it has taken the volume; should it be earlier, the answer is the Refusal.
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    kill(child->pid(), SIGKILL);
  });
  const absl::Status status = child->Decode(bytes, *header, {}, {}).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status) || ReasonOf(status) == Reason::kDecoderBusy)
      << status;
}

TEST(ChildPool, CancelAndDeadlineEndTheWaitForAChild) {
  ChildPool pool(ChildWith("loop"));
  std::stop_source stop;
  exec::Context context;
  context.stop = stop.get_token();
  const std::jthread canceller([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  EXPECT_TRUE(absl::IsCancelled(DecodeIn(pool, Encoded(), "", context).status()));
  exec::Context late;
  late.deadline = exec::Context::Clock::now() + std::chrono::milliseconds(100);
  EXPECT_TRUE(absl::IsDeadlineExceeded(DecodeIn(pool, Encoded(), "", late).status()));
}

TEST(ChildPool, AProgramThatCannotBeStartedIsNotTheCallersFault) {
  for (const char* program : {"/no/such/program", "/bin/true"}) {
    ChildPool pool({program});
    const absl::Status status = DecodeIn(pool, Encoded()).status();
    EXPECT_EQ(ReasonOf(status), Reason::kDecoderBusy) << program << ": " << status;
    EXPECT_TRUE(absl::IsUnavailable(status));
  }
}

TEST(ChildPool, DamagedVolumesByTheDozenGetTheAnswersOfThisProcess) {
  const size_t descriptors = test::OpenDescriptors();
  {
    ChildPool pool(ThisProgramAsChild());
    std::mt19937 random(7);
    const std::string good = Encoded(VolumeCompression::kZip);
    for (int n = 0; n < (kSanitized ? 6 : 24); ++n) {
      std::string bad = good;
      for (int flips = 0; flips < 3; ++flips) {
        bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
      }
      if (n % 3 == 0) bad.resize(random() % bad.size());
      const auto here = DecodeVolume(VolumeEncoding::kOpenExr, bad);
      const auto there = DecodeIn(pool, bad);
      EXPECT_EQ(there.status(), here.status());
      if (!here.ok() || !there.ok()) continue;
      EXPECT_EQ(*here, *there);
    }
  }
  EXPECT_EQ(test::OpenDescriptors(), descriptors);
  EXPECT_EQ(test::Zombies(), 0);
}

}  // namespace
}  // namespace bccskel::server
