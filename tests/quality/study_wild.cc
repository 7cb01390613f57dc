#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_file.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/quality/disturb.h"
#include "tests/quality/measure.h"
#include "tests/quality/studies.h"
#include "tests/quality/wild_figures.h"

// Lost and spurious ends of figures as people have them.

namespace bccskel::quality {
namespace {

constexpr double kMargin = 4;

// One object of the study and how its skeleton was judged.
struct WildRow {
  std::string name;  // of the class
  std::string as;
  int variant = 0;
  uint64_t seed = 0;
  uint64_t wanted_points = 0;
  double noise = 0;
  bool knows_ends = true;
  int tips = 0;
  int ends = 0;
  TipMatch match = {};
  double line_mean = 0;  // way from the curves to the middle of limbs
  double line_largest = 0;
  int junctions = 0;
  int true_junctions = -1;
  uint64_t object_points = 0;
  double pruning_ms = 0;
  double total_ms = 0;

  bool IsExact() const {
    return match.lost == 0 && match.spurious == 0 &&
           (true_junctions < 0 || junctions == true_junctions);
  }
};

Vector InWorld(const WorldPoint& p) { return {p[0], p[1], p[2]}; }

// Needs: the sketch and the graph lie in one world.
void JudgeEnds(const Sketch& sketch, const SkeletonGraph& graph, WildRow& row) {
  std::vector<Vector> ends;
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind == NodeKind::kEnd) ends.push_back(InWorld(graph.PositionOf(node.at)));
  }
  row.ends = static_cast<int>(ends.size());
  row.knows_ends = sketch.knows_ends;
  if (!sketch.knows_ends) return;
  row.tips = static_cast<int>(sketch.tips.size());
  std::vector<TipPair> pairs;
  for (size_t t = 0; t < sketch.tips.size(); ++t) {
    const Tip& tip = sketch.tips[t];
    for (size_t e = 0; e < ends.size(); ++e) {
      const double gap = DistanceToSegment(ends[e], tip.inner, tip.outer);
      if (gap <= tip.reach) pairs.push_back({gap, t, e});
    }
  }
  row.match = MatchNearest(std::move(pairs), sketch.tips.size(), ends.size());
}

// Of the places of the curves that lie beside a piece of the line.
void JudgeLine(const Sketch& sketch, const SkeletonGraph& graph, WildRow& row) {
  int count = 0;
  for (const SkeletonEdge& edge : graph.edges) {
    for (const WorldPoint& place : SmoothCurve(graph, edge)) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Piece& piece : sketch.line) {
        const Vector way = InWorld(place) - piece.from, axis = piece.to - piece.from;
        const double t = Dot(way, axis) / Dot(axis, axis);
        const double off = Length(way - t * axis);
        if (t > 0 && t < 1 && off < piece.from_radius) nearest = std::min(nearest, off);
      }
      if (std::isinf(nearest)) continue;
      row.line_mean += nearest;
      row.line_largest = std::max(row.line_largest, nearest);
      ++count;
    }
  }
  if (count > 0) row.line_mean /= count;
}

double Milliseconds(StageTimings::Duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

absl::Status Dump(const std::string& folder, const WildRow& row, const Volume& object) {
  if (folder.empty()) return absl::OkStatus();
  std::string name = row.name;
  std::ranges::replace(name, ' ', '-');
  return WriteVolumeFile(
      absl::StrFormat("%s/%s-%d-seed%d-%s-%d-noise%g.bccb", folder, name, row.variant, row.seed,
                      row.as, row.wanted_points, 100 * row.noise),
      object);
}

// What the figure is on either grid, before noise.
struct WildObject {
  Sketch sketch;
  std::optional<Volume> volume;
  std::optional<VoxelMask> mask;
};

absl::StatusOr<WildObject> Draw(const WildFigure& figure, const WildRow& row) {
  const Grid grid = row.as == "mask" ? Grid::kCubic : Grid::kBcc;
  const uint64_t seed = 1000 * row.seed + static_cast<uint64_t>(row.variant);
  const auto draw = [&](double size) {
    shapes::Random random(seed);
    const Sketch sketch = figure.draw({random, size}, figure.values);
    return Moved(Turned(sketch, RandomFrame(seed)), kMargin, seed);
  };
  // Thin parts do not grow with the figure, so it takes a few tries.
  double size = 0.4 * std::cbrt(static_cast<double>(row.wanted_points));
  WildObject object;
  for (int tries = 0; tries < 6; ++tries) {
    object.sketch = draw(size);
    const double ratio = static_cast<double>(CountPoints(object.sketch, grid)) /
                         static_cast<double>(row.wanted_points);
    if (std::abs(ratio - 1) < 0.05) break;
    size /= std::cbrt(ratio);
  }
  if (grid == Grid::kCubic) {
    object.mask = SampleOnVoxels(object.sketch);
    return object;
  }
  BCCSKEL_ASSIGN_OR_RETURN(object.volume, SampleOnBcc(object.sketch));
  return object;
}

absl::StatusOr<WildRow> JudgeObject(const WildObject& object, WildRow row,
                                    const StudyOptions& options) {
  MaskObject input = {.volume = {}, .options = options.skeleton};
  if (object.mask) {
    VoxelMask mask = *object.mask;
    if (row.noise > 0) mask = WithTopologyKeepingNoise(std::move(mask), row.noise, row.seed);
    BCCSKEL_ASSIGN_OR_RETURN(input, Convert(mask, options.skeleton));
  } else {
    input.volume = row.noise > 0 ? WithTopologyKeepingNoise(*object.volume, row.noise, row.seed)
                                 : *object.volume;
  }
  BCCSKEL_RETURN_IF_ERROR(Dump(options.dump, row, input.volume));
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                           Skeletonize(input.volume, input.options, exec::Context()));
  JudgeEnds(object.sketch, result.graph, row);
  JudgeLine(object.sketch, result.graph, row);
  row.junctions = CountNodes(result.graph, NodeKind::kJunction);
  row.true_junctions = object.sketch.junctions;
  row.object_points = result.object_points;
  row.pruning_ms = Milliseconds(result.timings.pruning);
  row.total_ms = Milliseconds(result.timings.total);
  return row;
}

void PrintRow(const WildRow& row) {
  absl::PrintF(
      "{\"study\": \"wild\", \"class\": \"%s\", \"as\": \"%s\", \"variant\": %d, \"seed\": %d, "
      "\"points\": %d, \"object_points\": %d, \"noise\": %g, \"known\": %s, ",
      row.name, row.as, row.variant, row.seed, row.wanted_points, row.object_points, row.noise,
      row.knows_ends ? "true" : "false");
  absl::PrintF(
      "\"tips\": %d, \"ends\": %d, \"lost\": %d, \"spurious\": %d, \"mean_gap\": %.3f, "
      "\"largest_gap\": %.3f, \"line_mean\": %.3f, \"line_largest\": %.3f, \"junctions\": %d, "
      "\"true_junctions\": %d, \"pruning_ms\": %.2f, \"total_ms\": %.2f}\n",
      row.tips, row.ends, row.match.lost, row.match.spurious, row.match.mean_gap,
      row.match.largest_gap, row.line_mean, row.line_largest, row.junctions, row.true_junctions,
      row.pruning_ms, row.total_ms);
}

// All objects of a class, one way and size.
class ClassLine {
 public:
  void Add(const WildRow& row) {
    ++objects_;
    tips_ += row.tips;
    ends_ += row.ends;
    exact_ += row.knows_ends && row.IsExact() ? 1 : 0;
    knows_ends_ = row.knows_ends;
    auto& [lost, spurious] = by_noise_[row.noise];
    lost += row.match.lost;
    spurious += row.match.spurious;
    auto& [least, most] =
        ends_by_figure_.try_emplace(row.variant, row.ends, row.ends).first->second;
    least = std::min(least, row.ends);
    most = std::max(most, row.ends);
    gap_ = std::max(gap_, row.match.largest_gap);
    off_ = std::max(off_, row.line_mean);
    junctions_ += row.junctions;
    if (row.true_junctions > 0) true_junctions_ += row.true_junctions;
    pruning_ms_ += row.pruning_ms;
    total_ms_ += row.total_ms;
  }

  void Print(const std::string& name) const {
    absl::PrintF("%-11s %4d %5d ", name, objects_, tips_);
    for (const auto& [noise, counts] : by_noise_) {
      absl::PrintF(" %9s", knows_ends_ ? absl::StrFormat("%d/%d", counts.first, counts.second)
                                       : std::string("-"));
    }
    if (!knows_ends_) return PrintEnds();
    absl::PrintF("  %5s %6.1f %6.2f %7.1f %9s %8.1f %5.1f%%\n",
                 knows_ends_ ? std::to_string(exact_) : "-", gap_, off_,
                 static_cast<double>(ends_) / objects_,
                 true_junctions_ > 0 ? absl::StrFormat("%d/%d", junctions_, true_junctions_) : "-",
                 total_ms_ / objects_, 100 * pruning_ms_ / std::max(total_ms_, 1e-9));
  }

 private:
  // The fewest and the most of each figure, over poses and noise.
  void PrintEnds() const {
    absl::PrintF("  ends:");
    for (const auto& [figure, ends] : ends_by_figure_) {
      absl::PrintF(" %d to %d", ends.first, ends.second);
    }
    absl::PrintF("\n");
  }

  int objects_ = 0, tips_ = 0, ends_ = 0, exact_ = 0, junctions_ = 0, true_junctions_ = 0;
  bool knows_ends_ = true;
  std::map<double, std::pair<int, int>> by_noise_;     // lost and spurious
  std::map<int, std::pair<int, int>> ends_by_figure_;  // least and most
  double gap_ = 0, off_ = 0, pruning_ms_ = 0, total_ms_ = 0;
};

class WildStudy {
 public:
  explicit WildStudy(const StudyOptions& options) : options_(options) {}

  absl::Status Run(const std::string& as, uint64_t points) {
    if (!options_.json) PrintHead(as, points);
    ClassLine line, all;
    const std::span<const WildFigure> figures = WildFigures();
    std::string name;
    for (size_t n = 0; n < figures.size(); ++n) {
      const bool held_back = figures[n].judge_only && options_.half == Half::kTune;
      if (!options_.Wants(figures[n].name) || held_back) continue;
      if (name != figures[n].name) Finish(name, line);
      name = figures[n].name;
      BCCSKEL_RETURN_IF_ERROR(RunFigure(
          figures[n],
          {.name = name, .as = as, .variant = static_cast<int>(n), .wanted_points = points},
          [&](const WildRow& row) {
            line.Add(row);
            all.Add(row);
          }));
    }
    Finish(name, line);
    Finish("all", all);
    return absl::OkStatus();
  }

 private:
  void PrintHead(const std::string& as, uint64_t points) const {
    absl::PrintF("%s, %d points; lost/spurious ends by noise\n%-11s %4s %5s ", as, points, "class",
                 "objs", "tips");
    for (const double noise : options_.noise) absl::PrintF(" %8g%%", 100 * noise);
    absl::PrintF("  %5s %6s %6s %7s %9s %8s %6s\n", "exact", "gap", "off", "ends", "junctions",
                 "ms", "prune");
  }

  void Finish(const std::string& name, ClassLine& line) const {
    if (!name.empty() && !options_.json) line.Print(name);
    line = {};
    std::fflush(stdout);
  }

  template <typename Take>
  absl::Status RunFigure(const WildFigure& figure, WildRow row, Take take) {
    const bool all = options_.half == Half::kAll;
    for (int turn = 0; turn < options_.turns; ++turn) {
      const int seed = all ? turn : 2 * turn + (options_.half == Half::kJudge ? 1 : 0);
      row.seed = static_cast<uint64_t>(seed);
      BCCSKEL_ASSIGN_OR_RETURN(const WildObject object, Draw(figure, row));
      for (const double noise : options_.noise) {
        row.noise = noise;
        BCCSKEL_ASSIGN_OR_RETURN(const WildRow judged, JudgeObject(object, row, options_));
        if (options_.json) PrintRow(judged);
        take(judged);
      }
    }
    return absl::OkStatus();
  }

  const StudyOptions& options_;
};

}  // namespace

absl::Status StudyWild(const StudyOptions& options) {
  WildStudy study(options);
  for (const std::string& as : options.as) {
    for (const uint64_t points : options.points) BCCSKEL_RETURN_IF_ERROR(study.Run(as, points));
  }
  return absl::OkStatus();
}

absl::Status StudySpineLengths(const StudyOptions& options) {
  constexpr double kBall = 20, kSpine = 2, kOnSurface = 1e-6;
  for (const double length : {4, 6, 8, 12, 16, 20, 24, 26}) {
    const double place = kBall + length + 10;
    const Vector middle = {place, place, place};
    Sketch sketch{.pieces = {{middle, middle, kBall + kOnSurface, kBall + kOnSurface}}};
    for (const double way : {-1.0, 1.0}) {
      for (const Vector axis : {Vector{way, 0, 0}, Vector{0, way, 0}, Vector{0, 0, way}}) {
        const Vector end = middle + (kBall + length + kOnSurface) * axis;
        sketch.pieces.push_back(CutAtEnd({middle, end, kSpine + kOnSurface, kSpine + kOnSurface}));
      }
    }
    VoxelMask mask = SampleOnVoxels(sketch);
    BCCSKEL_ASSIGN_OR_RETURN(const MaskObject object, Convert(mask, options.skeleton));
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result,
                             Skeletonize(object.volume, object.options, exec::Context()));
    absl::PrintF("{\"study\": \"spine-lengths\", \"length\": %g, \"voxels\": %d, \"ends\": %d}\n",
                 length, mask.Count(), CountNodes(result.graph, NodeKind::kEnd));
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
