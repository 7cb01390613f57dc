#ifndef BCCSKEL_CORE_PRUNING_PERSISTENCE_H_
#define BCCSKEL_CORE_PRUNING_PERSISTENCE_H_

#include "core/pruning/branch_walk.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Does:  measures how long a branch would outlive its birth if thinning kept no isthmuses, in
//        passes. A branch would then lose its end point in every pass, but no point dies before the
//        pass after its birth: death(p) = 1 + max(birth(p), death of the next point outward). The
//        persistence of a point is (death - birth) / (1 + birth / 20), since points born deep need
//        more; that of the branch is the maximum over its points.
// Why:   from a bump toward the body births grow by about one per point, as shells do, so all
//        points die right after their births. Along a limb births hardly grow, so deaths fall
//        behind them. The maximum and not the last value counts, because a thin limb that continues
//        through a thick body is as much of a limb there.
// Source: Liu, Chambers, Letscher, Ju, "A simple and robust thinning algorithm on cell complexes"
//         (2010): birth and death are its isolation and removal iterations, their difference its
//         absolute medial persistence; the division stands for its relative one. The paper keeps or
//         removes single points, which shortens every limb by the threshold; here whole branches
//         are kept or removed.
double PersistenceOf(const ThinSet& set, const FreeBranch& branch);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PERSISTENCE_H_
