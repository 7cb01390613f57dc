
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/boundary_noise.h"
#include "tests/quality/disturb.h"
#include "tests/quality/known_figure.h"
#include "tests/quality/measure.h"
#include "tests/quality/methods.h"
#include "tests/quality/studies.h"

namespace bccskel::quality {
namespace {

constexpr std::array<double, 5> kNoise = {0, 0.01, 0.02, 0.05, 0.10};

std::string InJson(const Offsets& offsets) {
  return absl::StrFormat("{\"mean\": %.4f, \"largest\": %.3f, \"bias\": %.4f}", offsets.mean,
                         offsets.largest, offsets.bias);
}

void PrintJudgment(const PlacedFigure& placed, const char* method, double noise, int turn,
                   const SkeletonizeResult& result) {
  const Judgment judged = Judge(placed, result);
  const KnownFigure& figure = placed.figure;
  const TipMatch& tips = judged.tips;
  absl::PrintF(
      "{\"study\": \"figures\", \"figure\": \"%s\", \"method\": \"%s\", \"noise\": %g, "
      "\"turn\": %d, \"points\": %d, \"known_line\": %s, ",
      figure.name, method, noise, turn, result.object_points,
      figure.line.empty() ? "false" : "true");
  absl::PrintF("\"raw\": %s, \"smooth\": %s, ", InJson(judged.raw), InJson(judged.smooth));
  absl::PrintF(
      "\"tips\": %d, \"ends\": %d, \"found\": %d, \"lost\": %d, \"spurious\": %d, "
      "\"mean_gap\": %.3f, \"largest_gap\": %.3f, ",
      figure.tips.size(), judged.ends, tips.found, tips.lost, tips.spurious, tips.mean_gap,
      tips.largest_gap);
  absl::PrintF(
      "\"forks\": %d, \"junctions\": %d, \"loops\": %d, \"loops_found\": %d, "
      "\"radius_bias\": %.4f, \"radius_error\": %.4f, \"length_error\": %.5f, "
      "\"clustered\": %.5f, \"simple_left\": %d, \"milliseconds\": %.2f}\n",
      figure.forks, judged.junctions, figure.loops, result.certificate.skeleton.loops,
      judged.radius_bias, judged.radius_error, judged.length_error, judged.clustered,
      judged.simple_left, std::chrono::duration<double, std::milli>(result.timings.total).count());
}

// Plain flips, which open tunnels and enclose cavities, and what is meant against them.
absl::Status StudyFlips(const PlacedFigure& placed, int turn) {
  SkeletonizeOptions options;
  options.preparing = {
      .denoise_passes = 1, .cavities = CavityFilling::kOn, .components = KeptComponents::kLargest};
  for (const double noise : {0.02, 0.05, 0.10}) {
    BCCSKEL_ASSIGN_OR_RETURN(
        const Volume object,
        shapes::WithBoundaryNoise(placed.object, noise, static_cast<uint64_t>(turn)));
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                             Skeletonize(object, options, exec::Context()));
    PrintJudgment(placed, "default, plain flips denoised", noise, turn, result);
  }
  return absl::OkStatus();
}

Volume Noisy(const PlacedFigure& placed, double noise, int turn) {
  if (noise == 0) return placed.object;
  return WithTopologyKeepingNoise(placed.object, noise, static_cast<uint64_t>(turn));
}

// Curves of isthmuses, pruned by how long they lasted.
absl::Status StudyIsthmuses(const PlacedFigure& placed, int turn) {
  SkeletonizeOptions options;
  options.thinning.kind = SkeletonKind::kIsthmusCurve;
  options.pruning.rule = PruningRule::kPersistence;
  for (const double noise : kNoise) {
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                             Skeletonize(Noisy(placed, noise, turn), options, exec::Context()));
    PrintJudgment(placed, "isthmuses by persistence, Euclidean", noise, turn, result);
  }
  return absl::OkStatus();
}

absl::Status StudyFigure(const KnownFigure& figure, uint64_t points, int turn) {
  BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure placed, Place(figure, points));
  for (const double noise : kNoise) {
    const Volume object = Noisy(placed, noise, turn);
    for (const Method& method : kMethods) {
      BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result, SkeletonizeBy(method, object));
      PrintJudgment(placed, method.name, noise, turn, result);
    }
  }
  BCCSKEL_RETURN_IF_ERROR(StudyIsthmuses(placed, turn));
  return StudyFlips(placed, turn);
}

}  // namespace

absl::Status StudyFigures(const StudyOptions& size) {
  for (const KnownFigure& figure : KnownFigures()) {
    const int turns = figure.turns ? size.turns : 1;
    for (int turn = 0; turn < turns; ++turn) {
      const Frame frame = figure.turns ? RandomFrame(static_cast<uint64_t>(turn)) : Frame();
      BCCSKEL_RETURN_IF_ERROR(StudyFigure(Turned(figure, frame), size.points.front(), turn));
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
