#ifndef BCCSKEL_CORE_CERTIFICATE_COMPONENT_SETS_H_
#define BCCSKEL_CORE_CERTIFICATE_COMPONENT_SETS_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/certificate/background_gaps.h"
#include "core/certificate/phase_components.h"
#include "core/exec/context.h"
#include "core/exec/union_find.h"
#include "core/volume/volume.h"

namespace bccskel {

// The connected components of an object, or of its background including the outside. The partition
// does not depend on the threads; the names of the sets do.
class ComponentSets {
 public:
  // Incomplete if the context requests a stop. `object` must outlive this and has all bricks of the
  // known layers and no others; contacts with layers beyond are not linked.
  ComponentSets(const Volume& object, Phase phase, const exec::Context& context,
                const KnownLayers& known = {});

  int64_t count() const { return count_; }
  const PhaseComponents& pieces() const { return pieces_; }
  // The component of a piece: of a brick's main component or of a fragment.
  size_t SetOf(size_t piece) { return sets_.Find(piece); }
  // The component of a point. Needs: p is a point of `object`, whose components these are.
  size_t ComponentOf(const Volume& object, LatticePoint p) {
    const BrickAddress at = AddressOf(p);
    return SetOf(pieces_.NumberOf(*object.Find(BrickKey(at.brick)), at.bit));
  }
  // Component names are below this.
  size_t name_limit() const { return sets_.size(); }

  // The background where no bricks are stored.
  const BackgroundGaps& gaps() const { return *gaps_; }
  size_t SetOfGap(size_t node) { return sets_.Find(pieces_.number_limit() + node); }
  bool IsOutside(size_t set) { return set == SetOfGap(BackgroundGaps::kOutside); }

  // The points of brick n whose component passes.
  template <typename Passes>
  BrickBits PointsWhere(BrickIndex n, Passes passes) {
    BrickBits found;
    if (!pieces_.HasPoints(n)) return found;
    if (passes(SetOf(n))) found = pieces_.mains()[n];
    if (const BrickFragments* split = pieces_.fragments(n); split != nullptr) {
      split->fragments.ForEachSetBit([&](int bit) {
        if (passes(SetOf(pieces_.NumberOf(n, bit)))) found.Set(bit);
      });
    }
    return found;
  }

 private:
  int64_t LinkGaps(const exec::Context& context);
  int64_t LinkBricks(const Volume& object, const exec::Context& context);

  PhaseComponents pieces_;
  std::optional<BackgroundGaps> gaps_;
  UnionFind<size_t> sets_;  // pieces, then gaps
  int64_t count_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_COMPONENT_SETS_H_
