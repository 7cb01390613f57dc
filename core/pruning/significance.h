#ifndef BCCSKEL_CORE_PRUNING_SIGNIFICANCE_H_
#define BCCSKEL_CORE_PRUNING_SIGNIFICANCE_H_

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/pruning/ball_index.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/firm_depth.h"
#include "core/pruning/largest_run.h"
#include "core/pruning/point_table.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/way_on.h"
#include "core/volume/volume.h"

namespace bccskel {

// Tells limbs from bumps, ribs and strands by how far they stick out, in half-widths of the object.
// Does:  lets the branch go on to where its limb may end (WayOn), where that may matter, and finds
//        its run: leaving a body or going up a bump the radius D falls about as fast
//        as the way grows, along a limb it hardly falls. The run may begin anywhere, so what counts
//        is the limb, not where in a thick body its junction lies. Then
//          S = sqrt(elongation^2 - noise^2) / (D + 2.2 (H - D)) * uncovered,
//        noise the allowance for a branch of this radius and 2 units, stretched by how long voxels
//        are along it, D the radius where the limb begins, at one of the first seven of 11 places
//        of the run, whichever makes the most of it: the run may begin in something flat that the
//        limb leaves. H is the half-width of the object across the branch, the median of the places
//        from there on, each the widest of eight lines and, where S by these is 0.35 or more and H
//        more than 1.5 D + 1, of up to ten more beside the widest: lines that do not lie in a thin
//        plate leave it soon. Where the branch ends 1.2 times as thick as it begins, it is a bulge,
//        and only places outside 0.9 of the ball that it begins in count. In a wall, where H > 2.5
//        D + 3, the widest line goes on where the wall bends, round or with an edge; so do 16 lines
//        in the wall, of which the third shortest is W, the radius of the circle inscribed in the
//        wall. Where 0.4 (W(q) - W(p)) is more than 2 (D(q) - D(p)), it takes the place of that in
//        the elongation: in a wall W is what D is in space. `uncovered` is the share of the run
//        that lies outside 0.9 of the balls of other branches. In a limb H is D; a rib lies in
//        something wide; a strand lies in the balls of the strand beside it. A limb may begin late
//        in a long run through something wide, as a thumb does behind a palm. So the largest run of
//        the later half is evaluated, too, and so on; the largest S counts. On rough surfaces of
//        voxels D is measured without pits (FirmDepth), where that may decide. A branch that the
//        border of an image cuts off counts as going on beyond (GoOnBeyond()), unless it is shorter
//        than the radius at its end.
// S is a ratio of lengths of the shape. Only the noise goes with the sampling, so S is the same at
// any resolution and in any pose.
// Cost:  for each of these runs, of which there are one to five, 48 points of the branch; where it
//        may be the largest, 176 rays if it sticks out at all, up to 396 if it may stay and is not
//        round, and in a wall up to 198 more that follow it.
// Threads: one thread per instance; LookAhead() uses the context's.
class Significance {
 public:
  static constexpr size_t kPlaces = 11;  // of a run, evenly spaced
  static constexpr size_t kWork = 256;   // a branch takes as long as this many bricks elsewhere

  // Needs: `object` outlives this; `noise` is that of its surface; `way_on` in the same object,
  //        none for branches that end where thinning ended them; `firm_depth` in the same object,
  //        for radii without pits as far as the surface is rough, none for radii as they are;
  //        `border` of the image, where limbs that it cuts off go on.
  Significance(const Volume& object, const SurfaceNoise& noise,
               std::optional<WayOn> way_on = std::nullopt,
               std::optional<FirmDepth> firm_depth = std::nullopt,
               const std::optional<LatticeBox>& border = std::nullopt);

  // Needs: the branch is one of `set`, whose points are points of the object, and has a junction;
  //        it is always the same set, from which points go, and radii never change.
  double Of(const ThinSet& set, const FreeBranch& branch);
  // Of a path with two ends: by how much its two ways from the deepest point stick out, less a step
  // of the surface, in radii of that point. The width does not count: what is flat has a curve.
  double OfPath(const ThinSet& set, std::array<BranchPath, 2> ways) const;
  // Measures branches on the context's threads, so that Of() knows them; not all of them where the
  // context says to stop. Needs: as Of().
  void LookAhead(const ThinSet& set, std::span<const FreeBranch> branches,
                 const exec::Context& context);

 private:
  // What was found of a branch, which is asked for again whenever something near it goes.
  struct Verdict {
    LatticePoint junction;
    size_t points = 0;
    Run run;
    double value = 0;  // as if nothing of it were covered
  };

  // Across a branch, in one place of its run.
  struct Section {
    Coordinates middle, way;  // `way` of the branch, of length 1
    double radius = 0;
    Coordinates side = {0, 0, 0};  // of the widest line, of length 1
    double half_width = 0;         // along it, the mean of its two sides
    double inscribed = 0;          // radius of the circle inscribed in a wall; 0: not known yet
  };
  // Of a line that goes on in a bent wall.
  struct Front {
    Coordinates middle;  // of the wall
    Coordinates way;     // of length 1
    Coordinates normal;  // of the wall, of length 1
    double length = 0;   // so far
  };
  using Sections = std::array<Section, kPlaces>;

  Verdict Look(const ThinSet& set, const FreeBranch& branch);
  // Null if the branch was not looked at, or was another one.
  const Verdict* Known(const FreeBranch& branch) const;
  Run RunOf(const ThinSet& set, BranchPath& path);
  void LookPastPits(BranchPath& path);
  // As if nothing of it were covered.
  double ValueOf(const ThinSet& set, const BranchPath& path, const Run& run);
  // ValueOf() is no more, in floating point, too; without rays.
  double BeyondNoise(double elongation, double radius, const Coordinates& way) const;
  double ValueAtMost(const ThinSet& set, const BranchPath& path, const Run& run) const;
  double UncoveredShare(const ThinSet& set, const FreeBranch& branch, const Run& run);
  Sections SectionsAcross(const BranchPath& path, const Run& run, double reach);
  void TurnFinely(double reach, Section& section);
  bool Widen(const Coordinates& side, double reach, Section& section);
  void FollowWall(double reach, Section& section);
  void FindInscribed(Section& section);
  static Front FrontOf(const Section& section, const Coordinates& way);
  double WayInWall(Front front, double radius, double reach);
  bool GoOnInWall(Front& front, double out, double radius);
  double BestRoot(const ThinSet& set, const BranchPath& path, const Run& run,
                  const Sections& sections) const;
  double WayOut(const Coordinates& from, const Coordinates& way, double start, double reach);

  const SurfaceNoise noise_;
  const AxisScale scale_;
  NearbyBricks bricks_;
  std::optional<WayOn> way_on_;
  std::optional<FirmDepth> firm_depth_;
  const std::optional<LatticeBox> border_;
  std::optional<BallIndex> balls_;  // made when it is asked for first
  PointTable<Verdict> verdicts_;    // by the branch's end
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SIGNIFICANCE_H_
