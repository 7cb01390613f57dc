#ifndef BCCSKEL_CORE_PIPELINE_OPTION_WORDS_H_
#define BCCSKEL_CORE_PIPELINE_OPTION_WORDS_H_

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// The names of option values, the same on the command line and in results.
template <typename Enum, size_t kCount>
using Words = std::array<std::pair<const char*, Enum>, kCount>;

inline constexpr Words<ThinningMethod, 3> kMethodWords = {
    {{"directional", ThinningMethod::kDirectional},
     {"directional-alternating", ThinningMethod::kDirectionalAlternating},
     {"symmetric", ThinningMethod::kSymmetric}}};
inline constexpr Words<SkeletonKind, 4> kKindWords = {
    {{"curve", SkeletonKind::kCurve},
     {"surface", SkeletonKind::kSurface},
     {"kernel", SkeletonKind::kKernel},
     {"isthmus-curve", SkeletonKind::kIsthmusCurve}}};
inline constexpr Words<DistanceKind, 3> kDistanceWords = {
    {{"chamfer", DistanceKind::kChamfer},
     {"chamfer-optimal", DistanceKind::kChamferOptimal},
     {"euclidean", DistanceKind::kEuclidean}}};
inline constexpr Words<StubblePolicy, 3> kStubbleWords = {{{"keep-two", StubblePolicy::kKeepTwo},
                                                           {"literal", StubblePolicy::kLiteral},
                                                           {"none", StubblePolicy::kNone}}};
inline constexpr Words<PruningRule, 5> kPruningWords = {
    {{"significance", PruningRule::kSignificance},
     {"length", PruningRule::kLength},
     {"relative-length", PruningRule::kRelativeLength},
     {"persistence", PruningRule::kPersistence},
     {"none", PruningRule::kNone}}};
inline constexpr Words<TipPlacement, 2> kTipsWords = {
    {{"ridge", TipPlacement::kRidge}, {"as-thinned", TipPlacement::kAsThinned}}};
inline constexpr Words<ObjectSource, 4> kSourceWords = {
    {{"points", ObjectSource::kPoints},
     {"voxels", ObjectSource::kVoxels},
     {"refined-voxels", ObjectSource::kRefinedVoxels},
     {"sampled-voxels", ObjectSource::kSampledVoxels}}};
// The last one occurs only in results.
inline constexpr Words<Border, 4> kBorderWords = {{{"auto", Border::kAuto},
                                                   {"ends", Border::kEnds},
                                                   {"continues", Border::kContinues},
                                                   {"slice", Border::kContinuesAcrossSlice}}};
inline constexpr Words<PreparingStepKind, 6> kPreparingWords = {
    {{"denoise", PreparingStepKind::kDenoise},
     {"fill-cavities", PreparingStepKind::kFillCavities},
     {"fill-tunnels", PreparingStepKind::kFillTunnels},
     {"join-gaps", PreparingStepKind::kJoinGaps},
     {"drop-small-components", PreparingStepKind::kDropSmallComponents},
     {"keep-largest-component", PreparingStepKind::kKeepLargestComponent}}};

template <typename Enum, size_t kCount>
constexpr const char* WordFor(const Words<Enum, kCount>& words, Enum value) {
  for (const auto& [word, meaning] : words) {
    if (meaning == value) return word;
  }
  return "";
}

// An option and the value it had, as text.
struct OptionFact {
  enum class Type : uint8_t { kText, kNumber };

  const char* name;
  std::string value;
  Type type = Type::kText;
};

// All options on which the result depends, except the points to keep; including options that this
// kind of skeleton does not use.
std::vector<OptionFact> FactsOf(const SkeletonizeOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_OPTION_WORDS_H_
