#include "proto/wire/options.h"

#include <gmock/gmock.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "proto/wire/error_details.h"

namespace bccskel::wire {
namespace {

std::string ViolatedField(const absl::Status& status) {
  const auto bad_request = BadRequestOf(status);
  return bad_request.has_value() ? bad_request->field_violations(0).field() : "none";
}

// What the other side makes of options that are sent.
SkeletonizeOptions Received(const SkeletonizeOptions& options) {
  return FromMessage(ToMessage(options), "options").value();
}

TEST(OptionsRoundTrip, KeepsEveryField) {
  for (StubblePolicy stubble :
       {StubblePolicy::kKeepTwo, StubblePolicy::kLiteral, StubblePolicy::kNone}) {
    for (ThinnessCleanup cleanup : {ThinnessCleanup::kOn, ThinnessCleanup::kOff}) {
      const ThinningOptions sent = {.stubble = stubble,
                                    .cleanup = cleanup,
                                    .shell_width = 1.5,
                                    .last_shell = 3,
                                    .keep = {{1, 3, 5}, {2, 0, 4}}};
      const ThinningOptions back = Received({.thinning = sent}).thinning;
      EXPECT_EQ(back.stubble, stubble);
      EXPECT_EQ(back.cleanup, cleanup);
      EXPECT_EQ(back.shell_width, 1.5);
      EXPECT_EQ(back.last_shell, 3);
      EXPECT_EQ(back.keep, sent.keep);
    }
  }
}

TEST(OptionsRoundTrip, KeepsTheKindOfDistance) {
  for (DistanceKind kind :
       {DistanceKind::kChamfer, DistanceKind::kChamferOptimal, DistanceKind::kEuclidean}) {
    EXPECT_EQ(Received({.distance = kind}).distance, kind);
  }
}

TEST(OptionsRoundTrip, KeepsTheMethodAndTheKindOfSkeleton) {
  for (ThinningMethod method :
       {ThinningMethod::kDirectional, ThinningMethod::kDirectionalAlternating,
        ThinningMethod::kSymmetric}) {
    EXPECT_EQ(Received({.thinning = {.method = method}}).thinning.method, method);
  }
  for (SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface, SkeletonKind::kKernel,
                            SkeletonKind::kIsthmusCurve}) {
    const ThinningOptions sent = {.method = ThinningMethod::kSymmetric, .kind = kind};
    EXPECT_EQ(Received({.thinning = sent}).thinning.kind, kind);
  }
}

TEST(Options, RefusesAKindThatTheMethodDoesNotGive) {
  v1::SkeletonizeOptions message;
  message.set_method(v1::THINNING_METHOD_DIRECTIONAL);
  message.set_kind(v1::SKELETON_KIND_SURFACE);
  const absl::Status refused = FromMessage(message, "options").status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ViolatedField(refused), "options");
}

TEST(OptionsRoundTrip, KeepsPruning) {
  for (PruningRule rule : {PruningRule::kSignificance, PruningRule::kLength,
                           PruningRule::kRelativeLength, PruningRule::kNone}) {
    for (TipPlacement tips : {TipPlacement::kRidge, TipPlacement::kAsThinned}) {
      const PruningOptions pruning = {rule, 2.5, tips};
      EXPECT_EQ(Received({.pruning = pruning}).pruning, pruning);
    }
  }
}

TEST(OptionsRoundTrip, KeepsTheReachOfJunctions) {
  for (double reach : {0.0, 1.0, kDefaultJunctionReach}) {
    EXPECT_EQ(Received({.junction_reach = reach}).junction_reach, reach);
  }
  EXPECT_EQ(FromMessage(v1::SkeletonizeOptions(), "options")->junction_reach,
            kDefaultJunctionReach);
}

TEST(OptionsRoundTrip, KeepsTheBorder) {
  for (const Border border : {Border::kEnds, Border::kContinues, Border::kContinuesAcrossSlice}) {
    EXPECT_EQ(Received({.border = border}).border, border);
  }
}

TEST(OptionsRoundTrip, KeepsThreeNumbersOfSlabs) {
  const std::array<int32_t, 3> slabs = {1, 8, 3};
  const v1::SkeletonizeOptions message = ToMessage(SkeletonizeOptions{.voxel_slabs = slabs});
  EXPECT_EQ(FromMessage(message, "options")->voxel_slabs, slabs);
  EXPECT_EQ(ToMessage(SkeletonizeOptions()).voxel_slabs_size(), 0);
  const std::pair<std::vector<uint32_t>, const char*> wrong[] = {
      {{1, 2}, "2 numbers, must be 3 or none"},
      {{1, 1, 0}, "0 slabs of a voxel: must be 1 to 8"},
      {{9, 1, 1}, "9 slabs of a voxel: must be 1 to 8"},
      {{1, 1, 5000}, "5000 slabs of a voxel: must be 1 to 8"},
      {{1, 4'000'000'000, 1}, "must be 1 to 8"}};
  for (const auto& [given, told] : wrong) {
    v1::SkeletonizeOptions bad;
    bad.mutable_voxel_slabs()->Assign(given.begin(), given.end());
    EXPECT_THAT(FromMessage(bad, "options").status().message(), testing::HasSubstr(told));
  }
}

TEST(OptionsRoundTrip, KeepsPreparing) {
  for (CavityFilling cavities : {CavityFilling::kOff, CavityFilling::kOn}) {
    for (KeptComponents components : {KeptComponents::kAll, KeptComponents::kLargest}) {
      const PreparingOptions preparing = {.denoise_passes = 3,
                                          .cavities = cavities,
                                          .join_gaps = 1.25,
                                          .min_component_points = uint64_t{1} << 40,
                                          .min_component_volume = 2.5,
                                          .components = components,
                                          .tunnel_width = 0.5,
                                          .tunnel_cells = 3};
      EXPECT_EQ(Received({.preparing = preparing}).preparing, preparing);
    }
  }
}

TEST(Options, RefusePreparingOutOfRange) {
  v1::SkeletonizeOptions message;
  message.mutable_preparing()->set_denoise_passes(17);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options.preparing");
  message.Clear();
  message.mutable_preparing()->set_min_component_volume(-1);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options.preparing");
}

TEST(Options, RefusePruningByNoLength) {
  v1::SkeletonizeOptions message;
  message.set_pruning_rule(v1::PRUNING_RULE_LENGTH);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options.pruning_threshold");
}

TEST(Options, TakeTheSlopeRuleOfOldForTheDefaultButNotItsMargin) {
  v1::SkeletonizeOptions message;
  message.set_pruning_rule(v1::PRUNING_RULE_SLOPE);
  EXPECT_EQ(FromMessage(message, "options")->pruning, PruningOptions());
  message.set_pruning_threshold(4);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options.pruning_threshold");
}

TEST(Options, TakePersistenceWithIsthmusesAlone) {
  v1::SkeletonizeOptions message;
  message.set_pruning_rule(v1::PRUNING_RULE_PERSISTENCE);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options");
  message.set_kind(v1::SKELETON_KIND_ISTHMUS_CURVE);
  const auto options = FromMessage(message, "options").value();
  EXPECT_EQ(options.pruning.rule, PruningRule::kPersistence);
  EXPECT_EQ(ToMessage(options).pruning_rule(), v1::PRUNING_RULE_PERSISTENCE);
}

TEST(Options, AnEmptyMessageMeansTheDefaults) {
  const auto options = FromMessage(v1::SkeletonizeOptions(), "options").value();
  const ThinningOptions defaults = SkeletonizeOptions().thinning;
  EXPECT_EQ(options.thinning.stubble, defaults.stubble);
  EXPECT_EQ(options.thinning.cleanup, defaults.cleanup);
  EXPECT_EQ(options.thinning.method, defaults.method);
  EXPECT_EQ(options.thinning.kind, defaults.kind);
  EXPECT_EQ(options.thinning.shell_width, defaults.shell_width);
  EXPECT_EQ(options.thinning.last_shell, defaults.last_shell);
  EXPECT_TRUE(options.thinning.keep.empty());
  EXPECT_EQ(options.distance, SkeletonizeOptions().distance);
  EXPECT_EQ(options.pruning, PruningOptions());
  EXPECT_EQ(options.preparing, PreparingOptions());
}

// Sets each enumeration of a part of the options in turn to a number that has no name yet.
void ExpectRefusesTheFuture(v1::SkeletonizeOptions& options, google::protobuf::Message& part,
                            const std::string& path) {
  for (int n = 0; n < part.GetDescriptor()->field_count(); ++n) {
    const google::protobuf::FieldDescriptor& field = *part.GetDescriptor()->field(n);
    if (field.enum_type() == nullptr) continue;
    part.GetReflection()->SetEnumValue(&part, &field, 99);
    EXPECT_EQ(ViolatedField(FromMessage(options, "options").status()), path + field.name());
    part.Clear();
  }
}

TEST(Options, RefusesEnumeratorsFromTheFuture) {
  v1::SkeletonizeOptions options;
  ExpectRefusesTheFuture(options, options, "options.");
  ExpectRefusesTheFuture(options, *options.mutable_preparing(), "options.preparing.");
}

TEST(Options, RefusesColumnsOfDifferentLengths) {
  v1::SkeletonizeOptions message;
  message.mutable_keep()->add_x(1);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options.keep");
}

TEST(Options, RefusesMorePointsToKeepThanAJobMayHold) {
  v1::SkeletonizeOptions message;
  for (int n = 0; n < 16384; ++n) {
    message.mutable_keep()->add_x(n);
    message.mutable_keep()->add_y(0);
    message.mutable_keep()->add_z(0);
  }
  EXPECT_TRUE(FromMessage(message, "options").ok());
  message.mutable_keep()->add_x(1);
  message.mutable_keep()->add_y(1);
  message.mutable_keep()->add_z(1);
  const absl::Status status = FromMessage(message, "options").status();
  EXPECT_EQ(ViolatedField(status), "options.keep");
  EXPECT_THAT(status.message(), testing::HasSubstr("16385 points, the limit is 16384"));
}

TEST(Options, RefusesWhatTheCoreRefuses) {
  v1::SkeletonizeOptions message;
  message.set_shell_width(0.1);
  EXPECT_EQ(ViolatedField(FromMessage(message, "options").status()), "options");
  message.Clear();
  message.set_last_shell(-1);
  EXPECT_EQ(FromMessage(message, "options").status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel::wire
