#ifndef BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_
#define BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_

namespace bccskel {

// Raised whenever the same volume and options may give another skeleton: stored results are found
// again by it.
inline constexpr char kAlgorithmVersion[] = "6";

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_
