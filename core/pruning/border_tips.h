#ifndef BCCSKEL_CORE_PRUNING_BORDER_TIPS_H_
#define BCCSKEL_CORE_PRUNING_BORDER_TIPS_H_

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// The trunks of a set that does not change: which curve leads on from a junction. Remembers them,
// since the crossings of a spongy object share theirs.
class TrunkArms {
 public:
  struct Arm {
    std::vector<LatticePoint> points;
    LatticePoint end;  // the last one's neighbor
  };

  // The deepest curve that leads away from the junction, except for the one that begins with `own`;
  // without points if there is none.
  const Arm& Deepest(LatticePoint junction, LatticePoint own, const ThinSet& set);

 private:
  static Arm Find(LatticePoint junction, LatticePoint own, const ThinSet& set);

  std::map<std::pair<LatticePoint, LatticePoint>, Arm> arms_;
};

// Finds how the curves of limbs that the border of an image cuts off lead straight to the middles
// of their cuts. Thinning takes the border for the surface, so it ends such a curve where the ball
// touches the border: a radius before it, and off the middle if the cut is oblique.
// Threads: one thread per instance.
class BorderTips {
 public:
  static constexpr size_t kWork = 64;  // of a place near the border, for Context::WorkersFor()

  struct Way {
    size_t axis = 0;  // across which the border cuts the limb
    size_t from = 0;  // position in the path of the point before the first place
    std::vector<Coordinates> places;
  };

  // Needs: `object` outlives this. `image` is the box of the image's outermost lattice points.
  BorderTips(const Volume& object, const LatticeBox& image);

  // The way of a limb whose balls but the last do not touch the border: from the last such ball
  // straight on. None if the branch ends elsewhere, or if the limb does not continue to the border
  // in about the same width: a tip or a body that only touches it was not cut off.
  // Where a branch leaves the limb so near its cut that all balls behind it touch the border, the
  // limb is the trunk behind the junction.
  // Needs: the path leads from the junction, if there is one, to an end of `set`, which belongs to
  //        the object.
  std::optional<Way> WayOf(std::span<const LatticePoint> path,
                           const std::optional<LatticePoint>& junction, const ThinSet& set);

  // Adds branches for limbs that end at the border, but whose curves turn into thinner limbs that
  // leave them shortly before: from the point of the set that is nearest to the middle of the
  // cut. Appends the new points to `added`. Each touches the set only at the point before it, so
  // the topology stays. `radius` belongs to the object. Adds none or some if the context requests a
  // stop.
  void AddBranches(ExactRadius& radius, ThinSet& set, PointsByAxis& added,
                   const exec::Context& context);

 private:
  // Where the border cuts a limb off.
  struct Cut {
    Coordinates middle = {};
    double radius = 0;  // of the part around the middle in which one curve is enough

    bool HasOneOf(std::span<const LatticePoint> ends, const ThinSet& set) const;
  };
  struct NewBranch {
    LatticePoint from;
    Way way;
    Cut cut;
  };
  struct Face {
    size_t axis = 0;
    int32_t side = 1;  // -1: the low one
  };
  // Where a curve comes so near to a face that its balls touch it.
  struct Crossing {
    Face face;
    LatticePoint last, touching;  // neighbors
  };
  // A part of a plane in the object.
  struct Section {
    Coordinates middle = {};
    double area = 0;  // square lattice units
  };

  struct Limb {
    size_t from = 0;         // position in the path
    Section last;            // across the limb there
    Coordinates way = {};    // toward the border, of length 1
    double reach = 0;        // of searches for the limb's surface, lattice units
    Coordinates start = {};  // of the straight way
  };

  double OutFrom(const Coordinates& place, const Face& face) const;
  // The faces at most so far away, the nearest first.
  std::vector<Face> FacesNear(LatticePoint p, double reach) const;
  std::optional<Section> SectionAt(Coordinates middle, const std::array<Coordinates, 2>& plane,
                                   double reach);
  // Whether the border cuts a part of the section across the path there off.
  bool TouchesAcross(const Face& face, std::span<const LatticePoint> path, size_t n,
                     const ThinSet& set);
  // The limb before its balls touch the face.
  std::optional<Limb> LimbBefore(const Face& face, std::span<const LatticePoint> path,
                                 const ThinSet& set);
  // The same of the trunk that the branch continues, from behind its junction.
  std::optional<Limb> TrunkBefore(const Face& face, std::span<const LatticePoint> path,
                                  LatticePoint junction, const ThinSet& set);
  std::optional<Coordinates> MiddleOfCut(const Face& face, const Limb& limb);
  bool Touches(LatticePoint p, const Face& face, const ThinSet& set) const;
  // In the order of faces and points.
  std::vector<Crossing> Crossings(const ThinSet& set) const;
  // Whether the curve behind the crossing leaves the face again in a limb about as thick.
  bool GoesOnAsThick(const Crossing& crossing, const ThinSet& set, TrunkArms& arms) const;
  // The branch of the limb that leads to the crossing. None if one of the ends lies in its cut, or
  // if the curve comes near its middle. `points`: all of the set.
  std::optional<NewBranch> BranchFrom(const Crossing& crossing, std::span<const LatticePoint> ends,
                                      std::span<const LatticePoint> points, const ThinSet& set,
                                      TrunkArms& arms);
  static Way StraightTo(const Coordinates& middle, const Face& face, const Limb& limb);

  const AxisScale scale_;
  const Coordinates low_, high_;  // of the image
  NearbyBricks bricks_;
  CrossSections sections_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BORDER_TIPS_H_
