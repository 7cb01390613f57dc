#ifndef BCCSKEL_SERVER_SERVICE_ALGORITHM_H_
#define BCCSKEL_SERVER_SERVICE_ALGORITHM_H_

namespace bccskel::server {

// Raised whenever the same volume and options may give another skeleton: stored results are found
// again by it.
inline constexpr char kAlgorithmVersion[] = "2";

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_ALGORITHM_H_
