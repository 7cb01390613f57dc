#ifndef BCCSKEL_CORE_PRUNING_PERSISTENCE_H_
#define BCCSKEL_CORE_PRUNING_PERSISTENCE_H_

#include "core/pruning/branch_walk.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Does:  measures how long a branch would outlive its birth if thinning kept no isthmuses, in
// passes.
//        Then a branch loses its end point in every pass, but no point dies before the pass after
//        its birth: death(p) = 1 + the later of birth(p) and the death of the point outside p.
//        A point persists for death - birth passes, of which those born deep need more: they are
//        divided by 1 + birth / 20. The most of all points is the branch's.
// Why:   from a bump toward the body births grow by about one a point, as shells do, so all points
//        die right after their births. Along a limb they hardly grow, and the fire falls behind.
//        The most and not the last, because a thin limb that leads on through a thick body is as
//        much of a limb there.
// Source: Liu, Chambers, Letscher, Ju, "A simple and robust thinning algorithm on cell complexes"
//         (2010): birth and death are its isolation and removal iterations, the difference its
//         absolute medial persistence; the division stands for its relative one. There single
//         points are kept or not, which shortens every limb by the threshold; here branches are.
double PersistenceOf(const ThinSet& set, const FreeBranch& branch);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PERSISTENCE_H_
