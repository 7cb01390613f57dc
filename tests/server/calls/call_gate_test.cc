#include "server/calls/call_gate.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr Method kMethod{"JobService/GetJob"};
constexpr std::chrono::milliseconds kAtOnce(0);

class Stream final : public OpenStream {
 public:
  void EndEarly(const absl::Status& why) override { end = why; }
  absl::Status end;
};

class CallGateTest : public testing::Test {
 protected:
  const std::unique_ptr<Callers> callers_ = *Callers::Create("");
  CallGate gate_{*callers_};
  const grpc::CallbackServerContext context_;
};

TEST_F(CallGateTest, RefusesCallsThatComeWhileTheServerStops) {
  EXPECT_TRUE(gate_.Enter(context_, kMethod).ok());
  gate_.CutOff(kAtOnce);
  EXPECT_EQ(ReasonOf(gate_.Enter(context_, kMethod).status()), Reason::kDraining);
}

TEST_F(CallGateTest, EndsAStreamThatHasEnteredBeforeAndBeginsAfterTheCut) {
  const CallFacts facts = *gate_.Enter(context_, kMethod);
  const auto early = std::make_shared<Stream>(), late = std::make_shared<Stream>();
  gate_.open_streams().Add(early, facts);
  EXPECT_TRUE(early->end.ok());
  gate_.CutOff(kAtOnce);
  gate_.open_streams().Add(late, facts);
  EXPECT_EQ(ReasonOf(early->end), Reason::kDraining);
  EXPECT_EQ(ReasonOf(late->end), Reason::kDraining);
  gate_.open_streams().Remove(*early);
  gate_.open_streams().Remove(*late);
}

TEST_F(CallGateTest, WaitsForTheAnswersOfCallsBeforeTheCut) {
  bool answered = false;
  std::jthread answer([&answered, call = gate_.BeginAnswer()]() mutable {
    answered = true;
    call = nullptr;
  });
  gate_.CutOff(std::chrono::hours(1));
  EXPECT_TRUE(answered);
}

}  // namespace
}  // namespace bccskel::server
