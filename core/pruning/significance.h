#ifndef BCCSKEL_CORE_PRUNING_SIGNIFICANCE_H_
#define BCCSKEL_CORE_PRUNING_SIGNIFICANCE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/prepare/border_cuts.h"
#include "core/pruning/ball_index.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/largest_run.h"
#include "core/pruning/point_table.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tip_extender.h"
#include "core/volume/volume.h"

namespace bccskel {

// Distinguishes limbs from bumps, ribs and strands by how far they stick out, in half-widths of the
// object. README.md of this folder gives the steps, the constants and the reasons.
// Does:  extends the branch beyond its end where that may matter (TipExtender,
//        ExtendAcrossBorder()) and finds its run, the part from q to p with the largest
//        (elongation - noise) / D(q). The elongation is |p - q| - 2 (D(q) - D(p)), D the radius, on
//        rough surfaces of voxels without pits (FirmDepth). The significance is sqrt(elongation^2 -
//        (noise + 2)^2) / (D(q) + 2.2 w) times the share of the run outside 0.9 of the balls of
//        other branches. w is the median of H - D along the run, where H is the half-width of the
//        object across the branch. In walls, lines across the branch follow the wall, and 0.4 of
//        the fall of the inscribed circle's radius replaces 2 (D(q) - D(p)) if it is larger. The
//        best run of the later half of a run is evaluated in the same way, and so on, and so is the
//        best run before it; the largest result counts. The end of a body that thin limbs leave
//        before it has a significance of its own (OfBodyEnd()), which counts if it is larger.
//        Branches into corners of strips and into collars around shafts get a fixed, small value.
// Why:   the significance is a ratio of lengths of the shape, in which only the noise depends on
//        the sampling. So it is the same at any resolution and in any pose.
// Cost:  48 points of the branch for each of its runs, one or several. For a run that may be the
//        best, 176 rays if it sticks out at all, up to 396 if the branch may stay and is not round,
//        and in a wall up to 198 more that follow it.
// Threads: one thread per instance; OfAll() uses the context's.
class Significance {
 public:
  static constexpr size_t kPlaces = kRunPlaces;  // positions of a run, evenly spaced
  static constexpr size_t kWork = 256;           // work of a branch, for Context::WorkersFor()

  // Needs: `object` outlives this; `noise` is that of its surface. `extender`, of the same object,
  //        extends branches beyond the end that thinning gave them; none: they end there.
  //        `firm_depth`, of the same object, measures radii without pits, in proportion to the
  //        roughness of the surface; none: radii as they are. `border`: of the image; limbs that it
  //        cuts off are extended. `cuts`: those whose middles are ends; it outlives this; null:
  //        none.
  Significance(const Volume& object, const SurfaceNoise& noise,
               std::optional<TipExtender> extender = std::nullopt,
               std::optional<FirmDepth> firm_depth = std::nullopt,
               const std::optional<LatticeBox>& border = std::nullopt,
               const BorderCuts* cuts = nullptr);

  // The significance of a branch.
  // Needs: the branch belongs to `set`, whose points are points of the object, and has a junction.
  //        All calls pass the same set; its points may be removed, but their radii never change.
  double Of(const ThinSet& set, const FreeBranch& branch);
  // The same of several branches, on the context's threads; some are -infinity if it requests a
  // stop.
  std::vector<double> OfAll(const ThinSet& set, std::span<const FreeBranch> branches,
                            const exec::Context& context);
  // Forgets the branches that were measured.
  void Forget() { verdicts_ = {}; }
  // Uses these balls instead of indexing those of the set at the first use.
  void Share(const BallIndex& balls) { balls_ = balls; }
  // Where a body has an end: at a junction, or where its curve turns into a limb. There the end may
  // lie within the ball, and only the side without the limb shows how wide the body is.
  enum class BodyAt : uint8_t { kJunction, kTurn };
  // The significance of a branch as the end of a body (IsBodyEnd()), which counts in Of() where
  // MayHaveBodyEnds(): how far it sticks out of the ball at its junction, relative to that ball's
  // radius and the width, as above. -infinity if the branch is not the end of a body, or the value
  // is at most `least` or 0.2. Needs: as Of().
  double OfBodyEnd(const ThinSet& set, const FreeBranch& branch, BodyAt at = BodyAt::kJunction,
                   double least = -std::numeric_limits<double>::infinity());
  // Whether a ball of this radius at a junction is at least `least` times the noise and the margin.
  static constexpr double kLeastBall = 2.5;
  bool MayHaveBodyEnds(double radius, double least = kLeastBall) const;
  // Whether the next point of a path lies in the ball of a branch other than those at the junction
  // from which the path comes (BallIndex). Needs: the path begins with the junction.
  // `radius`: that of the next point, or more.
  bool IsCovered(const ThinSet& set, std::span<const LatticePoint> path, LatticePoint next,
                 double radius);
  // The significance of a path with two ends: how far its two halves stick out of the ball at the
  // deepest point, minus one step of the surface, in radii of that ball. The width does not count,
  // since a flat object has a curve. `ways`: each leads from the deepest point to an end.
  double OfPath(const ThinSet& set, std::array<BranchPath, 2> ways) const;

 private:
  // The cached result for a branch, needed again whenever something near it is removed.
  struct Verdict {
    LatticePoint junction;
    size_t points = 0;
    Run run;
    double value = 0;                                 // without the factor `uncovered`
    double beside_trunk = 0;                          // the same if the other branches are round
    std::optional<bool> is_arbitrary = std::nullopt;  // IsArbitrary(), once asked
  };

  using Sections = std::array<CrossSection, kPlaces>;

  // A part of a run, from a root to a later place.
  struct Part {
    size_t root, tip;
    Coordinates way;  // from the root to the tip
    double length;    // of `way`
    double wider;     // the median of half-width - radius from the root on
    double bound;     // upper bound of the value, with or without walls
  };

  // Whether the branch ends beside the middle of a cut, to which another branch leads.
  bool LeadsBesideCut(const ThinSet& set, const FreeBranch& branch) const;
  Verdict Look(const ThinSet& set, const FreeBranch& branch);
  // The value of a limb that leaves a trunk, by its width beside the trunk; 0 if it does not stick
  // out, or too little to be worth more than `least`.
  double BesideTrunk(const ThinSet& set, const BranchPath& path, const Run& run, double least);
  // Replaces the best run by this one if its value is larger.
  void Consider(const ThinSet& set, const BranchPath& path, const Run& run, Verdict& best);
  // Null if the end has no cached result or its branch has changed.
  Verdict* Known(const FreeBranch& branch);
  Run RunOf(const ThinSet& set, BranchPath& path);
  void LookPastPits(BranchPath& path);
  // The value of a run without the factor `uncovered`; not exact if it is at most `least`, and
  // rough if it is at most 0.35, less than the default threshold.
  double ValueOf(const ThinSet& set, const BranchPath& path, const Run& run,
                 double least = -std::numeric_limits<double>::infinity());
  double RoughValueOf(const std::vector<Part>& parts, const Sections& sections,
                      double width_near_tip) const;
  // An upper bound of ValueOf() without rays; it holds in floating point, too.
  double ValueAtMost(const ThinSet& set, const BranchPath& path, const Run& run) const;
  double UncoveredShare(const ThinSet& set, const FreeBranch& branch, const Run& run);
  Sections SectionsAcross(const BranchPath& path, const Run& run, double reach);
  // The parts of the run, without widths and bounds.
  static std::vector<Part> PartsOf(const ThinSet& set, const BranchPath& path, const Run& run);
  // Sets their widths and bounds; returns the largest bound. `first_own`: widths count from there.
  double Bound(std::vector<Part>& parts, const Sections& sections, size_t first_own) const;
  // `narrower`: by how much the object becomes narrower along the part.
  double ValueOf(const Part& part, const Sections& sections, double narrower) const;

  const SurfaceNoise noise_;
  const AxisScale scale_;
  CrossSections sections_;
  std::optional<TipExtender> extender_;
  std::optional<FirmDepth> firm_depth_;
  const std::optional<LatticeBox> border_;
  const BorderCuts* const cuts_;
  std::optional<BallIndex> balls_;  // created on first use
  PointTable<Verdict> verdicts_;    // by the end of the branch
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SIGNIFICANCE_H_
