#include "proto/wire/enumerators.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "proto/wire/options.h"
#include "proto/wire/result.h"
#include "proto/wire/volume_encoding.h"
#include "tests/proto/message_enumerators.h"
#include "tests/support/enum_values.h"

namespace bccskel::wire {
namespace {

using test::ForEachEnumerator, test::ValuesOf;

TEST(Enumerators, OfOptionsAreAllKnown) {
  v1::SkeletonizeOptions message;
  const auto expect_known = [&](const auto& /*field*/, const auto& enumerator) {
    // What these rules need.
    const v1::PruningRule rule = message.pruning_rule();
    if (rule == v1::PRUNING_RULE_LENGTH) message.set_pruning_threshold(1);
    if (rule == v1::PRUNING_RULE_PERSISTENCE) message.set_kind(v1::SKELETON_KIND_ISTHMUS_CURVE);
    const absl::Status status = FromMessage(message, "options").status();
    EXPECT_TRUE(status.ok()) << enumerator.full_name() << ": " << status;
    message.clear_pruning_threshold();
    if (rule == v1::PRUNING_RULE_PERSISTENCE) message.clear_kind();
  };
  ForEachEnumerator(message, expect_known);
  ForEachEnumerator(*message.mutable_preparing(), expect_known);
}

// Each value survives and is told, except points, which are the source where none is told.
template <typename Value, typename... Members>
void ExpectEachKept(const char* field_name, Members... members) {
  for (const Value value : ValuesOf<Value>()) {
    SkeletonizeOptions options;
    (options.*....*members) = value;
    if (options.pruning.rule == PruningRule::kLength) options.pruning.threshold = 1;
    if (options.pruning.rule == PruningRule::kPersistence) {
      options.thinning.kind = SkeletonKind::kIsthmusCurve;
    }
    const v1::SkeletonizeOptions message = ToMessage(options);
    auto back = FromMessage(message, "options");
    ASSERT_TRUE(back.ok()) << field_name << ' ' << static_cast<int>(value) << ' ' << back.status();
    EXPECT_EQ(((*back).*....*members), value) << field_name;
    const google::protobuf::Message* parent = &message;
    const auto* field = message.GetDescriptor()->FindFieldByName(field_name);
    if (field == nullptr) {
      parent = &message.preparing();
      field = parent->GetDescriptor()->FindFieldByName(field_name);
    }
    ASSERT_NE(field, nullptr) << field_name;
    EXPECT_EQ(parent->GetReflection()->GetEnumValue(*parent, field) == 0,
              options.source == ObjectSource::kPoints && std::string(field_name) == "object_source")
        << field_name << ' ' << static_cast<int>(value);
  }
}

TEST(Enumerators, OfTheCoreAreAllToldInOptions) {
  using Options = SkeletonizeOptions;
  ExpectEachKept<StubblePolicy>("stubble_policy", &Options::thinning, &ThinningOptions::stubble);
  ExpectEachKept<ThinnessCleanup>("thinness_cleanup", &Options::thinning,
                                  &ThinningOptions::cleanup);
  ExpectEachKept<ThinningMethod>("method", &Options::thinning, &ThinningOptions::method);
  ExpectEachKept<SkeletonKind>("kind", &Options::thinning, &ThinningOptions::kind);
  ExpectEachKept<DistanceKind>("distance_kind", &Options::distance);
  ExpectEachKept<PruningRule>("pruning_rule", &Options::pruning, &PruningOptions::rule);
  ExpectEachKept<TipPlacement>("tip_placement", &Options::pruning, &PruningOptions::tips);
  ExpectEachKept<ObjectSource>("object_source", &Options::source);
  ExpectEachKept<Border>("border", &Options::border);
  ExpectEachKept<CavityFilling>("cavity_filling", &Options::preparing, &PreparingOptions::cavities);
  ExpectEachKept<KeptComponents>("kept_components", &Options::preparing,
                                 &PreparingOptions::components);
}

TEST(Enumerators, OfStepsAndEncodingsAreAllTold) {
  std::set<int> told;
  for (const VolumeEncoding encoding : ValuesOf<VolumeEncoding>()) {
    told.insert(ToMessage(encoding));
    EXPECT_EQ(MeaningOf(ToMessage(encoding), kVolumeEncodings), encoding);
  }
  EXPECT_EQ(told.size(), static_cast<size_t>(v1::VolumeEncoding_descriptor()->value_count() - 1));
  EXPECT_FALSE(told.contains(v1::VOLUME_ENCODING_UNSPECIFIED));

  SkeletonizeResult result;
  for (const PreparingStepKind kind : ValuesOf<PreparingStepKind>()) {
    result.preparing.push_back({.kind = kind});
  }
  result.sha256 = std::string(64, '0');
  const v1::SkeletonSummary summary = SummaryOf(result, {});
  const auto back = FromMessage(summary);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->preparing, result.preparing);
  told.clear();
  for (const v1::PreparingStep& step : summary.preparing()) told.insert(step.kind());
  EXPECT_EQ(told.size(),
            static_cast<size_t>(v1::PreparingStepKind_descriptor()->value_count() - 1));
}

}  // namespace
}  // namespace bccskel::wire
