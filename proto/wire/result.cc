#include "proto/wire/result.h"

#include <optional>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/duration.h"
#include "proto/wire/enumerators.h"
#include "proto/wire/options.h"
#include "proto/wire/placement.h"

namespace bccskel::wire {
namespace {

using std::chrono::nanoseconds;

constexpr int kDigestBytes = 32;

void Set(v1::BettiNumbers* message, const BettiNumbers& betti) {
  message->set_components(betti.components);
  message->set_loops(betti.loops);
  message->set_cavities(betti.cavities);
}

BettiNumbers FromMessage(const v1::BettiNumbers& message) {
  return {message.components(), message.loops(), message.cavities()};
}

void Set(v1::StageTimings* message, const StageTimings& timings, const JobFacts& facts) {
  *message->mutable_queue() = DurationMessage(facts.queued);
  *message->mutable_decode() = DurationMessage(facts.decoded);
  *message->mutable_preparing() = DurationMessage(timings.preparing);
  *message->mutable_distance() = DurationMessage(timings.distance);
  *message->mutable_shells() = DurationMessage(timings.shells);
  *message->mutable_thinning() = DurationMessage(timings.thinning);
  *message->mutable_cleanup() = DurationMessage(timings.cleanup);
  *message->mutable_pruning() = DurationMessage(timings.pruning);
  *message->mutable_certificate() = DurationMessage(timings.certificate);
  *message->mutable_graph() = DurationMessage(timings.graph);
  *message->mutable_total() = DurationMessage(timings.total);
}

StageTimings FromMessage(const v1::StageTimings& message) {
  return {.preparing = NanosecondsOf(message.preparing()),
          .distance = NanosecondsOf(message.distance()),
          .shells = NanosecondsOf(message.shells()),
          .thinning = NanosecondsOf(message.thinning()),
          .cleanup = NanosecondsOf(message.cleanup()),
          .pruning = NanosecondsOf(message.pruning()),
          .certificate = NanosecondsOf(message.certificate()),
          .graph = NanosecondsOf(message.graph()),
          .total = NanosecondsOf(message.total())};
}

constexpr std::pair<v1::PreparingStepKind, PreparingStepKind> kPreparingSteps[] = {
    {v1::PREPARING_STEP_KIND_DENOISE, PreparingStepKind::kDenoise},
    {v1::PREPARING_STEP_KIND_FILL_CAVITIES, PreparingStepKind::kFillCavities},
    {v1::PREPARING_STEP_KIND_FILL_TUNNELS, PreparingStepKind::kFillTunnels},
    {v1::PREPARING_STEP_KIND_JOIN_GAPS, PreparingStepKind::kJoinGaps},
    {v1::PREPARING_STEP_KIND_DROP_SMALL_COMPONENTS, PreparingStepKind::kDropSmallComponents},
    {v1::PREPARING_STEP_KIND_KEEP_LARGEST_COMPONENT, PreparingStepKind::kKeepLargestComponent}};

void Set(v1::PreparingStep* message, const PreparingStep& step) {
  message->set_kind(EnumeratorOf(step.kind, kPreparingSteps));
  message->set_count(step.count);
  message->set_points_added(step.points_added);
  message->set_points_removed(step.points_removed);
}

absl::StatusOr<PreparingStep> FromMessage(const v1::PreparingStep& message) {
  const std::optional<PreparingStepKind> kind = MeaningOf(message.kind(), kPreparingSteps);
  if (!kind.has_value()) {
    return absl::DataLossError(
        absl::StrCat("the summary has a preparing step of kind ", int{message.kind()}));
  }
  return PreparingStep{*kind, message.count(), message.points_added(), message.points_removed()};
}

// A newer server may have options that this client does not know.
absl::StatusOr<SkeletonizeOptions> OptionsOf(const v1::SkeletonSummary& message) {
  absl::StatusOr<SkeletonizeOptions> options =
      wire::FromMessage(message.options(), "summary.options");
  if (options.ok()) return options;
  return absl::DataLossError(std::string(options.status().message()));
}

}  // namespace

v1::Certificate ToMessage(const Certificate& certificate) {
  v1::Certificate message;
  Set(message.mutable_input(), certificate.input);
  Set(message.mutable_skeleton(), certificate.skeleton);
  message.set_simple_points_left(certificate.simple_points_left);
  if (certificate.mask.has_value()) Set(message.mutable_mask(), *certificate.mask);
  if (certificate.unprepared.has_value()) {
    Set(message.mutable_unprepared(), *certificate.unprepared);
  }
  return message;
}

Certificate FromMessage(const v1::Certificate& message) {
  std::optional<BettiNumbers> mask, unprepared;
  if (message.has_mask()) mask = FromMessage(message.mask());
  if (message.has_unprepared()) unprepared = FromMessage(message.unprepared());
  return {.mask = mask,
          .unprepared = unprepared,
          .input = FromMessage(message.input()),
          .skeleton = FromMessage(message.skeleton()),
          .simple_points_left = message.simple_points_left()};
}

v1::ShellProgress ToMessage(const exec::ShellProgress& progress, nanoseconds elapsed) {
  v1::ShellProgress message;
  message.set_shell(progress.shell);
  message.set_last_shell(progress.last_shell);
  message.set_points(progress.points);
  message.set_removed(progress.removed);
  message.set_remaining(progress.remaining);
  *message.mutable_elapsed() = DurationMessage(elapsed);
  return message;
}

exec::ShellProgress FromMessage(const v1::ShellProgress& message) {
  return {.shell = message.shell(),
          .last_shell = message.last_shell(),
          .points = message.points(),
          .removed = message.removed(),
          .remaining = message.remaining()};
}

v1::SkeletonSummary SummaryOf(const SkeletonizeResult& result, const JobFacts& facts) {
  const SkeletonGraph& graph = result.graph;
  v1::SkeletonSummary message;
  *message.mutable_certificate() = ToMessage(result.certificate);
  message.set_object_points(result.object_points);
  message.set_skeleton_points(result.skeleton_points);
  message.set_last_shell(result.last_shell);
  message.set_node_count(graph.nodes.size());
  message.set_edge_count(graph.edges.size());
  message.set_point_count(graph.points.size());
  message.set_sheet_point_count(graph.sheets.size());
  message.set_thin_volume_size_bytes(facts.thin_volume_size_bytes);
  *message.mutable_placement() = ToMessage(graph.placement);
  Set(message.mutable_timings(), result.timings, facts);
  message.set_sha256(absl::HexStringToBytes(result.sha256));
  message.set_algorithm_version(facts.algorithm_version);
  message.set_method(facts.method);
  message.set_threads(facts.threads);
  *message.mutable_options() = wire::ToMessage(result.options);
  for (const PreparingStep& step : result.preparing) Set(message.add_preparing(), step);
  return message;
}

JobFacts FactsOf(const v1::SkeletonSummary& message) {
  return {.queued = NanosecondsOf(message.timings().queue()),
          .decoded = NanosecondsOf(message.timings().decode()),
          .threads = message.threads(),
          .thin_volume_size_bytes = message.thin_volume_size_bytes(),
          .algorithm_version = message.algorithm_version(),
          .method = message.method()};
}

absl::StatusOr<SkeletonizeResult> FromMessage(const v1::SkeletonSummary& message) {
  if (message.sha256().size() != kDigestBytes) {
    return absl::DataLossError(absl::StrCat("the summary's digest has ", message.sha256().size(),
                                            " bytes, must be ", kDigestBytes));
  }
  SkeletonizeResult result;
  BCCSKEL_ASSIGN_OR_RETURN(result.graph.placement,
                           FromMessage(message.placement(), "summary.placement"));
  result.certificate = FromMessage(message.certificate());
  result.timings = FromMessage(message.timings());
  result.object_points = message.object_points();
  result.skeleton_points = message.skeleton_points();
  result.last_shell = message.last_shell();
  result.method = message.method();
  result.algorithm_version = message.algorithm_version();
  BCCSKEL_ASSIGN_OR_RETURN(result.options, OptionsOf(message));
  result.certificate.sampled = result.options.source == ObjectSource::kSampledVoxels;
  for (const v1::PreparingStep& step : message.preparing()) {
    BCCSKEL_ASSIGN_OR_RETURN(result.preparing.emplace_back(), FromMessage(step));
  }
  result.sha256 = absl::BytesToHexString(message.sha256());
  return result;
}

}  // namespace bccskel::wire
